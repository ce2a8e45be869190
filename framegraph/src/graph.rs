//! What was declared: flat arrays, the compiler's only input.
//!
//! A [`Graph`] is filled through [`Graph::add`] and the calls beside it, read by the phases, dumped, compared and copied;
//! it holds no closure and no GPU object. Its arrays ([`Tables`]) are shared with the plans that are made from it, never
//! copied: a graph that is declared anew ([`Graph::reset`]) goes on in arrays that no plan holds, so it and its plan take
//! turns with two sets, and a warm graph allocates nothing.

pub(crate) mod rows;
mod tables;

use crate::handle::Tag;
pub use rows::{Declared, Export, ExportKind, PassFlags, PassKind, Version};
use std::ops::Deref;
pub use tables::Tables;
use triomphe::Arc;

/// The most sets of arrays that a graph keeps for later beside its own: as many plans can be made from it in turns without
/// allocating.
const MOST_SPARES: usize = 4;

/// Everything that was declared for a frame. Reads as its [`Tables`].
#[derive(Debug)]
pub struct Graph {
    tables: Arc<Tables>,
    /// Arrays of earlier declarations: to be used again once no plan holds them.
    spares: Vec<Arc<Tables>>,
    identity: Box<u8>,
    resets: u32,
    /// What open scopes put in front of names.
    pub(crate) prefix: String,
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Self {
        let mut graph = Self {
            tables: Arc::default(),
            spares: Vec::new(),
            identity: Box::default(),
            resets: 0,
            prefix: String::new(),
        };
        graph.open().0.tag = graph.next_tag();
        graph
    }

    /// Forgets what was declared and keeps the memory; handles of before are refused from now on.
    pub fn reset(&mut self) {
        if Arc::count(&self.tables) > 1 {
            let free = self.spares.iter().position(|spare| Arc::count(spare) == 1);
            let next = free.map(|at| self.spares.remove(at)).unwrap_or_default();
            if self.spares.len() == MOST_SPARES {
                self.spares.remove(0);
            }
            self.spares.push(std::mem::replace(&mut self.tables, next));
        }
        self.prefix.clear();
        self.resets = self.resets.wrapping_add(1);
        let tag = self.next_tag();
        let (tables, _) = self.open();
        tables.clear();
        tables.tag = tag;
    }

    /// What handles of this declaration carry.
    fn next_tag(&self) -> Tag {
        let address = std::ptr::from_ref::<u8>(&*self.identity).addr() as u64;
        let mixed = (address ^ (u64::from(self.resets) << 40)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        Tag((mixed >> 32) as u32)
    }

    /// The arrays, to be changed, and what open scopes put in front of names. Where a plan or another graph holds the arrays
    /// too, this one goes on with a copy.
    #[inline]
    pub(crate) fn open(&mut self) -> (&mut Tables, &str) {
        (Arc::make_mut(&mut self.tables), &self.prefix)
    }

    /// Whether the two would compile to the same plan: everything but source locations is equal, clear values bit for bit.
    pub fn same_as(&self, other: &Self) -> bool {
        let shared = Arc::ptr_eq(&self.tables, &other.tables);
        self.errors.is_empty() && other.errors.is_empty() && (shared || self.tables.same_as(&other.tables))
    }

    /// Reads as `source` from now on, whose handles work on it: the two share their arrays until one of them changes.
    pub(crate) fn share(&mut self, source: &Self) {
        self.tables = Arc::clone(&source.tables);
    }

    /// Reads as a graph in which nothing was declared.
    pub(crate) fn forget(&mut self) {
        self.tables = Arc::default();
    }
}

impl Deref for Graph {
    type Target = Tables;

    #[inline]
    fn deref(&self) -> &Tables {
        &self.tables
    }
}

impl Default for Graph {
    fn default() -> Self {
        Self::new()
    }
}

impl Clone for Graph {
    /// A copy that the same handles work on.
    fn clone(&self) -> Self {
        let Self { tables, spares: _, identity: _, resets, prefix } = self;
        Self { tables: Arc::clone(tables), resets: *resets, prefix: prefix.clone(), ..Self::new() }
    }
}
