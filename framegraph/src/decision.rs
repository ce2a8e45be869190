//! The decision log: one record for every decision of the compiler, with a reason from a closed list.
//!
//! The phases write the log as they decide. Dumps, diffs and tests read it.

mod reason;

pub use reason::{MemoryNeed, Names, Reason, Refusal};

use crate::graph::Graph;
use crate::id::{PassId, ResourceId, StepId};
use crate::sanitize::escape_controls;

/// The subject of a decision.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A declared pass.
    Pass(PassId),
    /// The load of a resource at the start of a step.
    Load(StepId, ResourceId),
    /// The store of a resource at the end of a step.
    Store(StepId, ResourceId),
    /// A declared resource.
    Resource(ResourceId),
}

/// One decision of a compilation and its reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    /// The subject: a pass, a resource, a load or a store.
    pub subject: Subject,
    /// The decision and its reason.
    pub reason: Reason,
}

impl Decision {
    /// Returns the decision as a sentence with names. [`Plan::explained`](crate::Plan::explained) appends a hint.
    pub fn sentence(&self, graph: &Graph) -> String {
        let subject = match self.subject {
            Subject::Pass(p) => format!("pass `{}`", graph.pass_name(p)),
            Subject::Load(s, r) => format!("load of `{}` in step {}", graph.resource_name(r), s.index()),
            Subject::Store(s, r) => format!("store of `{}` in step {}", graph.resource_name(r), s.index()),
            Subject::Resource(r) => format!("resource `{}`", graph.resource_name(r)),
        };
        escape_controls(&format!("{subject}: {}", self.reason.sentence(graph))).into_owned()
    }
}
