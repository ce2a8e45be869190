//! The declared frame: flat arrays that are the compiler's only input.
//!
//! Passes and resources are added to a [`Graph`] with [`Graph::add`] and similar methods. A graph holds no closures and
//! no GPU objects, so it can be compared, copied and dumped.
//!
//! A graph shares its arrays ([`Tables`]) with the plans compiled from it; nothing is copied. [`Graph::reset`] switches
//! to arrays that no plan uses. A graph that is declared and compiled every frame alternates between two sets of arrays
//! and stops allocating.

pub(crate) mod rows;
mod tables;

use crate::handle::Tag;
pub use rows::{Declared, Export, ExportKind, PassFlags, PassKind, Version};
use std::ops::Deref;
pub use tables::Tables;
use triomphe::Arc;

/// Maximum number of spare array sets that a graph keeps.
///
/// This many plans can hold arrays of one graph before a reset has to allocate.
const MAX_SPARES: usize = 4;

/// The passes, resources and accesses declared for one frame. Dereferences to its [`Tables`].
///
/// ```
/// use framegraph::{ClearValue, DeclareError, Extent, Format, Graph, Intent, TextureDesc};
///
/// let mut graph = Graph::new();
/// let color = graph.add_fn("background", |pass| {
///     let color = pass.texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
///     pass.color(color, Intent::Clear(ClearValue::BLACK))
/// })?;
/// graph.export(color)?; // Without a use of its result, the pass would be culled.
/// assert_eq!(graph.pass_name(graph.find_pass("background").unwrap()), "background");
/// # Ok::<(), DeclareError>(())
/// ```
#[derive(Debug)]
pub struct Graph {
    tables: Arc<Tables>,
    /// Array sets of earlier declarations, reused once no plan holds them.
    spares: Vec<Arc<Tables>>,
    identity: Box<u8>,
    resets: u32,
    /// Prefix that the open scopes add to names.
    pub(crate) prefix: String,
}

impl Graph {
    /// Creates an empty graph.
    pub fn new() -> Self {
        let mut graph = Self {
            tables: Arc::default(),
            spares: Vec::new(),
            identity: Box::default(),
            resets: 0,
            prefix: String::new(),
        };
        graph.tables_mut().0.tag = graph.next_tag();
        graph
    }

    /// Removes all declarations and keeps the allocated memory.
    ///
    /// Handles issued before the reset are rejected from now on.
    pub fn reset(&mut self) {
        if Arc::count(&self.tables) > 1 {
            let free = self.spares.iter().position(|spare| Arc::count(spare) == 1);
            let next = free.map(|at| self.spares.remove(at)).unwrap_or_default();
            if self.spares.len() == MAX_SPARES {
                self.spares.remove(0);
            }
            self.spares.push(std::mem::replace(&mut self.tables, next));
        }
        self.prefix.clear();
        self.resets = self.resets.wrapping_add(1);
        let tag = self.next_tag();
        let (tables, _) = self.tables_mut();
        tables.clear();
        tables.tag = tag;
    }

    /// Returns the tag that handles of the current declaration carry.
    fn next_tag(&self) -> Tag {
        let address = std::ptr::from_ref::<u8>(&*self.identity).addr() as u64;
        let mixed = (address ^ (u64::from(self.resets) << 40)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        Tag((mixed >> 32) as u32)
    }

    /// Returns the arrays for writing, and the prefix of the open scopes.
    ///
    /// Copies the arrays first if a plan or another graph shares them.
    #[inline]
    pub(crate) fn tables_mut(&mut self) -> (&mut Tables, &str) {
        (Arc::make_mut(&mut self.tables), &self.prefix)
    }

    /// Returns `true` if both graphs compile to the same plan.
    ///
    /// Compares everything except source locations. Clear values are compared bit by bit.
    pub fn same_as(&self, other: &Self) -> bool {
        let shared = Arc::ptr_eq(&self.tables, &other.tables);
        self.errors.is_empty() && other.errors.is_empty() && (shared || self.tables.same_as(&other.tables))
    }

    /// Replaces the content of this graph with that of `source`, and accepts its handles. The two graphs share their
    /// arrays until one of them changes.
    pub(crate) fn share(&mut self, source: &Self) {
        self.tables = Arc::clone(&source.tables);
    }

    /// Replaces the content of this graph with that of an empty graph.
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
    /// Returns a copy that accepts the handles of the original.
    fn clone(&self) -> Self {
        let Self { tables, spares: _, identity: _, resets, prefix } = self;
        Self { tables: Arc::clone(tables), resets: *resets, prefix: prefix.clone(), ..Self::new() }
    }
}
