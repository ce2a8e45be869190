//! The reference semantics: the graph as it was declared, pass after pass, with nothing culled, moved or merged.
//!
//! Contents are symbols. A pass's output depends on everything that the pass reads, so two outputs are equal exactly when
//! the same pass wrote them from equal inputs; once every read of a plan is shown to see the symbol that it sees here, it
//! is enough to tell symbols apart by the pass that wrote them.

use super::subresource::Subresources;
use crate::graph::{Graph, PassFlags};
use crate::id::PassId;
use crate::resource::Kind;
use std::ops::Range;

/// What a subresource holds, as a symbol. The flat lattice of the oracle: garbage is its top, every other value stands
/// beside the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Value {
    /// Nothing that anybody may rely on.
    Garbage(Cause),
    /// A clear value, by its index in the graph.
    Cleared(u32),
    /// What it held when the frame began.
    Entry,
    /// What this pass wrote.
    Written(PassId),
}

/// How contents became garbage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cause {
    NeverWritten,
    HandedOver,
    Discarded,
    NotStored,
    DontCare,
    NoMemory,
    NotAttached,
}

impl Value {
    pub(super) fn is_garbage(self) -> bool {
        matches!(self, Self::Garbage(_))
    }

    /// The contents in words.
    pub(super) fn sentence(self, graph: &Graph) -> String {
        match self {
            Self::Garbage(cause) => format!("garbage ({})", cause.sentence()),
            Self::Cleared(index) => match graph.clears().get(index as usize) {
                Some(value) => format!("the clear value {value:?}"),
                None => format!("clear value {index}, which does not exist"),
            },
            Self::Entry => "the contents on entry".into(),
            Self::Written(pass) => format!("what `{}` wrote", graph.pass_name(pass)),
        }
    }
}

impl Cause {
    fn sentence(self) -> &'static str {
        match self {
            Self::NeverWritten => "nobody wrote it",
            Self::HandedOver => "another resource has its memory",
            Self::Discarded => "it was discarded",
            Self::NotStored => "it was written in the tile and not stored",
            Self::DontCare => "the step does not care for what was there",
            Self::NoMemory => "it has no memory",
            Self::NotAttached => "it is not attached",
        }
    }
}

/// Why contents must exist when the frame ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    Export,
    Import,
    History,
}

/// One subresource that one access reads, with what it holds then.
#[derive(Clone, Copy, Debug)]
pub(super) struct Read {
    pub(super) pass: PassId,
    pub(super) part: usize,
    pub(super) value: Value,
}

/// The declared frame, interpreted.
pub(super) struct Reference {
    /// Every read, in declaration order; those of one access follow [`Subresources::covered`].
    pub(super) reads: Vec<Read>,
    /// The reads of each access of the graph.
    pub(super) of_access: Vec<Range<usize>>,
    /// The reads of each pass.
    pub(super) of_pass: Vec<Range<usize>>,
    /// The reads, by the subresource that they read, each list in declaration order; and where each list starts.
    by_part: Vec<usize>,
    starts: Vec<usize>,
    /// What each subresource holds when the frame ends.
    pub(super) exit: Vec<Value>,
    /// Whether, and why, it must hold it.
    pub(super) wanted: Vec<Option<Wanted>>,
    /// The passes from which something that must survive, or a side effect, can be reached.
    pub(super) needed: Vec<bool>,
}

impl Reference {
    /// Interprets `graph`.
    pub(super) fn of_graph(graph: &Graph, parts: &Subresources) -> Self {
        let mut held = vec![Value::Garbage(Cause::NeverWritten); parts.total()];
        let mut wanted = vec![None; parts.total()];
        for (id, resource) in graph.resource_ids().zip(graph.resources()) {
            if resource.kind.defined_on_entry() {
                held[parts.all(id)].fill(Value::Entry);
            }
            let why = match resource.kind {
                Kind::HistoryCurrent { .. } | Kind::HistoryPrevious { .. } => Some(Wanted::History),
                kind => kind.kept_on_exit().then_some(Wanted::Import),
            };
            wanted[parts.all(id)].fill(why);
        }
        for export in graph.exports() {
            wanted[parts.all(export.resource)].fill(Some(Wanted::Export));
        }
        let mut reads = Vec::new();
        let mut of_access = vec![0..0; graph.accesses().len()];
        let mut of_pass = Vec::with_capacity(graph.passes().len());
        for pass in graph.pass_ids() {
            let first = reads.len();
            let ids = graph.passes()[pass.index()].accesses.range();
            for (id, access) in ids.zip(graph.accesses_of(pass)) {
                let start = reads.len();
                if access.mode.needs_contents() {
                    reads.extend(parts.covered(access.resource, access.range).map(|part| Read {
                        pass,
                        part,
                        value: held[part],
                    }));
                }
                of_access[id] = start..reads.len();
            }
            of_pass.push(first..reads.len());
            for access in graph.accesses_of(pass).iter().filter(|a| a.mode.writes()) {
                for part in parts.covered(access.resource, access.range) {
                    held[part] = Value::Written(pass);
                }
            }
        }
        let mut by_part: Vec<usize> = (0..reads.len()).collect();
        by_part.sort_by_key(|read| reads[*read].part);
        let starts = (0..=parts.total()).map(|part| by_part.partition_point(|read| reads[*read].part < part)).collect();
        let mut reference = Self { reads, of_access, of_pass, by_part, starts, exit: held, wanted, needed: Vec::new() };
        reference.needed = reference.reachable(graph);
        reference
    }

    /// The passes that what must survive, and what has side effects, depends on.
    fn reachable(&self, graph: &Graph) -> Vec<bool> {
        let mut needed = vec![false; graph.passes().len()];
        let mut open: Vec<PassId> =
            graph.pass_ids().filter(|p| graph.passes()[p.index()].flags.has(PassFlags::SIDE_EFFECT)).collect();
        let survives = self.exit.iter().zip(&self.wanted).filter(|(_, w)| w.is_some());
        open.extend(survives.filter_map(|(value, _)| match value {
            Value::Written(pass) => Some(*pass),
            _ => None,
        }));
        while let Some(pass) = open.pop() {
            if std::mem::replace(&mut needed[pass.index()], true) {
                continue;
            }
            for read in &self.reads[self.of_pass[pass.index()].clone()] {
                if let Value::Written(writer) = read.value {
                    open.push(writer);
                }
            }
        }
        needed
    }

    /// The passes that read what `writer` wrote into `part`.
    pub(super) fn readers(&self, writer: PassId, part: usize) -> impl Iterator<Item = PassId> {
        let of_part = &self.by_part[self.starts[part]..self.starts[part + 1]];
        let reads = of_part.iter().map(|read| &self.reads[*read]);
        reads.filter(move |read| read.value == Value::Written(writer)).map(|read| read.pass)
    }
}
