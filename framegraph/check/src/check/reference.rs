//! The reference semantics: runs the graph as declared, without culling, reordering or merging.
//!
//! Contents are symbols. A pass's output depends on everything it reads, so two outputs are equal if and only if the
//! same pass wrote them from equal inputs. If every read of a plan sees the same symbol as here, a symbol is identified
//! by its writer.

use super::subresource::Subresources;
use framegraph::access::{Access, AccessKind};
use framegraph::graph::{Graph, PassFlags};
use framegraph::id::PassId;
use framegraph::plan::Attachment;
use framegraph::resource::Kind;
use std::ops::Range;

/// Symbolic value of a part: an element of a flat lattice whose top is garbage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Value {
    /// Undefined contents.
    Garbage(Cause),
    /// A clear value, by its index in the graph.
    Cleared(u32),
    /// The contents at the start of the frame.
    Entry,
    /// The output of this pass.
    Written(PassId),
}

/// The cause of undefined contents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cause {
    NeverWritten,
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

    /// Describes the value.
    pub(super) fn sentence(self, graph: &Graph) -> String {
        match self {
            Self::Garbage(cause) => format!("garbage ({})", cause.sentence()),
            Self::Cleared(Attachment::ZERO) => "zero".into(),
            Self::Cleared(index) => match graph.clears().get(index as usize) {
                Some(value) => format!("the clear value {value:?}"),
                None => format!("clear value {index}, which does not exist"),
            },
            Self::Entry => "the initial contents".into(),
            Self::Written(pass) => format!("the output of `{}`", graph.pass_name(pass)),
        }
    }
}

impl Cause {
    fn sentence(self) -> &'static str {
        match self {
            Self::NeverWritten => "no pass wrote it",
            Self::Discarded => "it was discarded",
            Self::NotStored => "it was written in the tile and not stored",
            Self::DontCare => "its load op is don't care",
            Self::NoMemory => "it has no memory",
            Self::NotAttached => "it is not attached",
        }
    }
}

/// The reason why contents must exist at the end of the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wanted {
    Export,
    Import,
    History,
}

/// One part that an access reads, and its value at that time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Read {
    pub(super) pass: PassId,
    pub(super) access: usize,
    pub(super) part: usize,
    pub(super) value: Value,
}

/// The result of interpreting the declared frame.
pub(super) struct Reference {
    /// Every read, in declaration order; reads of one access are ordered like [`Subresources::kept`].
    pub(super) reads: Vec<Read>,
    /// The reads of each access of the graph.
    pub(super) of_access: Vec<Range<usize>>,
    /// Indices of the reads, grouped by part in declaration order, and the start of each group.
    by_part: Vec<usize>,
    starts: Vec<usize>,
    /// The final value of each part.
    pub(super) exit: Vec<Value>,
    /// The reason why each part must survive, if any.
    pub(super) wanted: Vec<Option<Wanted>>,
    /// Passes on which an exported result or a side effect depends.
    pub(super) needed: Vec<bool>,
    /// By access: color attachments that a pass of the plan blends into without a use of the result. Their previous
    /// contents are read without effect.
    pub(super) in_vain: Vec<bool>,
}

/// The passes and accesses that a result depends on.
struct Demand {
    passes: Vec<bool>,
    /// Accesses whose reads matter.
    accesses: Vec<bool>,
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
        for pass in graph.pass_ids() {
            let ids = graph.passes()[pass.index()].accesses.range();
            for (id, access) in ids.zip(graph.accesses_of(pass)) {
                let start = reads.len();
                if access.needs_contents() {
                    reads.extend(parts.kept(access).map(|part| Read { pass, access: id, part, value: held[part] }));
                }
                of_access[id] = start..reads.len();
            }
            for access in graph.accesses_of(pass).iter().filter(|a| a.mode.writes()) {
                for part in parts.covered(access.resource, access.range) {
                    held[part] = Value::Written(pass);
                }
            }
        }
        let mut by_part: Vec<usize> = (0..reads.len()).collect();
        by_part.sort_by_key(|read| reads[*read].part);
        let starts = (0..=parts.total()).map(|part| by_part.partition_point(|read| reads[*read].part < part)).collect();
        let (needed, in_vain) = (Vec::new(), vec![false; graph.accesses().len()]);
        let mut reference = Self { reads, of_access, by_part, starts, exit: held, wanted, needed, in_vain };
        let effects = graph.pass_ids().filter(|p| graph.passes()[p.index()].flags.has(PassFlags::SIDE_EFFECT));
        reference.needed = reference.demand(graph, parts, effects, |_| false).passes;
        reference
    }

    /// Determines the reads without effect of the running passes. All their resolves are used, except those in
    /// `dropped`.
    pub(super) fn settle(&mut self, graph: &Graph, parts: &Subresources, running: &[PassId], dropped: &[bool]) {
        let demand = self.demand(graph, parts, running.iter().copied(), |access| !dropped[access]);
        for pass in running {
            let ids = graph.passes()[pass.index()].accesses.range();
            for (id, access) in ids.zip(graph.accesses_of(*pass)) {
                self.in_vain[id] = access.needs_contents() && !demand.accesses[id];
            }
        }
    }

    /// Returns what must happen so that `passes` run and all required contents survive.
    ///
    /// A pass depends on everything it reads, with one exception: previous contents of a color attachment influence
    /// only its new contents and its resolve. A resolve is needed if it is read, if it survives, or if `averages` is
    /// true for its access.
    fn demand(
        &self,
        graph: &Graph,
        parts: &Subresources,
        passes: impl Iterator<Item = PassId>,
        averages: impl Fn(usize) -> bool,
    ) -> Demand {
        let mut demand =
            Demand { passes: vec![false; graph.passes().len()], accesses: vec![false; graph.accesses().len()] };
        let mut open: Vec<usize> = Vec::new();
        for pass in passes {
            demand.take(graph, pass, None, &mut open);
            let ids = graph.passes()[pass.index()].accesses.range().zip(graph.accesses_of(pass));
            for (id, access) in ids.clone().filter(|(_, a)| a.mode.writes() && graph.has_alias(a.resource)) {
                let adds = if access.kind == AccessKind::Resolve { averaged(graph, pass, access) } else { Some(id) };
                demand.take(graph, pass, adds, &mut open);
            }
            for (_, average) in ids.filter(|(id, a)| a.kind == AccessKind::Resolve && averages(*id)) {
                demand.take(graph, pass, averaged(graph, pass, average), &mut open);
            }
        }
        let survives = self.exit.iter().zip(&self.wanted).enumerate().filter(|(_, (_, wanted))| wanted.is_some());
        for (part, (value, _)) in survives {
            if let Value::Written(pass) = *value {
                let adds = self.adder(graph, parts, pass, part);
                demand.take(graph, pass, adds, &mut open);
            }
        }
        while let Some(access) = open.pop() {
            for read in &self.reads[self.of_access[access].clone()] {
                if let Value::Written(writer) = read.value {
                    let adds = self.adder(graph, parts, writer, read.part);
                    demand.take(graph, writer, adds, &mut open);
                }
            }
        }
        demand
    }

    /// Returns the color attachment whose previous contents influence the output of a pass in a part. The part belongs
    /// to the attachment, or to its resolve target.
    fn adder(&self, graph: &Graph, parts: &Subresources, pass: PassId, part: usize) -> Option<usize> {
        let mut writes = graph.passes()[pass.index()].accesses.range().zip(graph.accesses_of(pass)).filter(|(_, a)| {
            let drawn = matches!(a.kind, AccessKind::Color | AccessKind::Resolve);
            drawn && parts.covered(a.resource, a.range).any(|p| p == part)
        });
        let (id, access) = writes.next()?;
        if access.kind == AccessKind::Color { Some(id) } else { averaged(graph, pass, access) }
    }

    /// Returns the passes that read the output of `writer` in `part` with an effect.
    pub(super) fn readers(&self, writer: PassId, part: usize) -> impl Iterator<Item = PassId> {
        let of_part = &self.by_part[self.starts[part]..self.starts[part + 1]];
        let reads = of_part.iter().map(|read| &self.reads[*read]);
        let reads = reads.filter(|read| !self.in_vain[read.access]);
        reads.filter(move |read| read.value == Value::Written(writer)).map(|read| read.pass)
    }
}

/// Returns the access that draws the source of a resolve.
fn averaged(graph: &Graph, pass: PassId, resolve: &Access) -> Option<usize> {
    let mut ids = graph.passes()[pass.index()].accesses.range().zip(graph.accesses_of(pass));
    ids.find(|(_, a)| a.kind == AccessKind::Color && a.slot == resolve.slot).map(|(id, _)| id)
}

impl Demand {
    /// Adds a pass, and one of its accesses that blends into a color attachment. Reads to be processed are added to
    /// `open`.
    fn take(&mut self, graph: &Graph, pass: PassId, adds: Option<usize>, open: &mut Vec<usize>) {
        let accesses = graph.accesses_of(pass);
        let first = !std::mem::replace(&mut self.passes[pass.index()], true);
        for (id, access) in graph.passes()[pass.index()].accesses.range().zip(accesses) {
            if (first && access.kind != AccessKind::Color || adds == Some(id))
                && !std::mem::replace(&mut self.accesses[id], true)
            {
                open.push(id);
            }
        }
    }
}
