//! Why the plan is as it is: one record for every decision, with a reason from a closed list.
//!
//! The phases write the log while they decide; dumps, diff and tests read it. No reason is worked out afterwards.

mod reason;

pub(crate) use reason::Names;
pub use reason::{MemoryNeed, Reason, Refusal};

use crate::access::{Access, AccessKind, Mode};
use crate::graph::{PassFlags, PassKind};
use crate::id::{PassId, ResourceId, StepId};
use crate::plain::plain;
use crate::plan::Plan;

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
    /// What to change to have it otherwise; empty where there is nothing to want, or where passes, device and options of
    /// `plan`, whose decision it is, are such that the change is made already or cannot be.
    pub fn hint(&self, plan: &Plan) -> &'static str {
        let (general, graph) = (self.reason.hint(), plan.graph());
        let inlining = plan.options().inline && plan.caps().inline;
        match (self.reason, self.subject) {
            (Reason::Split(_, Refusal::SamePixelUnsupported), Subject::Pass(pass)) => {
                let accesses = graph.accesses_of(pass);
                let count = |counts: fn(&Access) -> bool| accesses.iter().filter(|a| counts(a)).count();
                let one_of_each = count(|a| a.kind == AccessKind::SamePixel) == 1
                    && count(|a| a.mode.writes() || a.kind.is_attachment()) == 1
                    && count(|a| a.kind == AccessKind::Color && a.mode != Mode::Modify) == 1;
                let samples = count(|a| a.kind == AccessKind::Sampled) != 0;
                let flags = graph.passes()[pass.index()].flags;
                if inlining && flags.has(PassFlags::POINTWISE) {
                    "choose a device that can, or mend what keeps the pass from being inlined"
                } else if inlining && one_of_each && !samples && !flags.has(PassFlags::SIDE_EFFECT) {
                    general
                } else {
                    "choose a device that can"
                }
            }
            (Reason::StoreReadBy(reader), Subject::Store(_, resource)) => {
                let reads = |a: &&Access| a.resource == resource && a.mode == Mode::Read;
                let mut reads = graph.accesses_of(reader).iter().filter(reads).map(|a| a.kind).peekable();
                if !plan.options().merge || !plan.caps().same_pixel && !inlining {
                    "choose a device that keeps same-pixel reads in the tile, and leave merging on"
                } else if graph.passes()[reader.index()].kind != PassKind::Raster {
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

    /// The decision in words, with names; what two passes would need to share a step along with it. `plan` is the one whose
    /// decision it is.
    pub fn sentence(&self, plan: &Plan) -> String {
        let graph = plan.graph();
        let subject = match self.subject {
            Subject::Pass(p) => format!("pass `{}`", graph.pass_name(p)),
            Subject::Load(s, r) => format!("load of `{}` in step {}", graph.resource_name(r), s.index()),
            Subject::Store(s, r) => format!("store of `{}` in step {}", graph.resource_name(r), s.index()),
            Subject::Resource(r) => format!("resource `{}`", graph.resource_name(r)),
        };
        let apart = matches!(self.reason, Reason::Split(..) | Reason::NotInlined(..));
        let hint = if apart { self.hint(plan) } else { "" };
        let hint = if hint.is_empty() { String::new() } else { format!("; {hint}") };
        plain(&format!("{subject}: {}{hint}", self.reason.sentence(graph))).into_owned()
    }
}
