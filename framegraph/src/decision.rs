//! Why the plan is as it is: one record for every decision, with a reason from a closed list.
//!
//! The phases write the log while they decide; dumps, diff and tests read it. No reason is worked out afterwards.

mod reason;

pub(crate) use reason::Names;
pub use reason::{MemoryNeed, Reason, Refusal};

use crate::graph::Graph;
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
    /// The decision in words, with names. [`Plan::explained`](crate::Plan::explained) has what to change along with it.
    pub fn sentence(&self, graph: &Graph) -> String {
        let subject = match self.subject {
            Subject::Pass(p) => format!("pass `{}`", graph.pass_name(p)),
            Subject::Load(s, r) => format!("load of `{}` in step {}", graph.resource_name(r), s.index()),
            Subject::Store(s, r) => format!("store of `{}` in step {}", graph.resource_name(r), s.index()),
            Subject::Resource(r) => format!("resource `{}`", graph.resource_name(r)),
        };
        plain(&format!("{subject}: {}", self.reason.sentence(graph))).into_owned()
    }
}
