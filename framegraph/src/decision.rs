//! Why the plan is as it is: one record for every decision, with a reason from a closed list.
//!
//! The phases write the log while they decide; dumps, diff and tests read it. No reason is worked out afterwards.

mod reason;

pub(crate) use reason::Names;
pub use reason::{MemoryNeed, Reason, Refusal};

use crate::access::{Access, AccessKind, Mode};
use crate::graph::{Graph, PassFlags, PassKind};
use crate::id::{PassId, ResourceId, StepId};
use crate::plain::plain;

/// What a decision is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A declared pass.
    Pass(PassId),
    /// What happens to one resource at the start of a step.
    Load(StepId, ResourceId),
    /// What happens to one resource at the end of a step.
    Store(StepId, ResourceId),
    /// A declared resource.
    Resource(ResourceId),
}

/// One decision of a compile: what it is about, and what was decided for which reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    /// The pass, resource, load or store that was decided about.
    pub subject: Subject,
    /// What was decided, and why.
    pub reason: Reason,
}

impl Decision {
    /// What to change to have it otherwise; empty where there is nothing to want, or where the passes of `graph` are such
    /// that the change is made already or cannot be.
    pub fn hint(&self, graph: &Graph) -> &'static str {
        let general = self.reason.hint();
        match (self.reason, self.subject) {
            (Reason::Split(_, Refusal::SamePixelUnsupported), Subject::Pass(pass)) => {
                let samples = graph.accesses_of(pass).iter().any(|a| a.kind == AccessKind::Sampled);
                if graph.passes()[pass.index()].flags.has(PassFlags::POINTWISE) {
                    "choose a device that can, or mend what keeps the pass from being inlined"
                } else if samples {
                    "choose a device that can"
                } else {
                    general
                }
            }
            (Reason::StoreReadBy(reader), Subject::Store(_, resource)) => {
                let reads = |a: &&Access| a.resource == resource && a.mode == Mode::Read;
                let mut reads = graph.accesses_of(reader).iter().filter(reads).map(|a| a.kind).peekable();
                if graph.passes()[reader.index()].kind != PassKind::Raster {
                    "read it in a raster pass that shares the step, to keep it in the tile"
                } else if reads.peek().is_some() && reads.all(|kind| kind != AccessKind::Sampled) {
                    "let the reader share the step, to keep it in the tile"
                } else {
                    general
                }
            }
            _ => general,
        }
    }

    /// The decision in words, with names; what two passes would need to share a step along with it.
    pub fn sentence(&self, graph: &Graph) -> String {
        let subject = match self.subject {
            Subject::Pass(p) => format!("pass `{}`", graph.pass_name(p)),
            Subject::Load(s, r) => format!("load of `{}` in step {}", graph.resource_name(r), s.index()),
            Subject::Store(s, r) => format!("store of `{}` in step {}", graph.resource_name(r), s.index()),
            Subject::Resource(r) => format!("resource `{}`", graph.resource_name(r)),
        };
        let apart = matches!(self.reason, Reason::Split(..) | Reason::NotInlined(..));
        let hint = if apart { self.hint(graph) } else { "" };
        let hint = if hint.is_empty() { String::new() } else { format!("; {hint}") };
        plain(&format!("{subject}: {}{hint}", self.reason.sentence(graph))).into_owned()
    }
}
