//! Passes and resources in errors.

use framegraph::{PassId, Plan, ResourceId};
use std::fmt;

/// A pass or resource that an error is about: its row in the graph, and its full name, which outlives the graph.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Named<I> {
    /// The row in the graph that was executed.
    pub id: I,
    /// The full name.
    pub name: String,
}

impl Named<PassId> {
    pub(crate) fn pass(plan: &Plan, id: PassId) -> Self {
        Self { id, name: plan.graph().pass_name(id).to_owned() }
    }
}

impl Named<ResourceId> {
    pub(crate) fn resource(plan: &Plan, id: ResourceId) -> Self {
        Self { id, name: plan.graph().resource_name(id).to_owned() }
    }
}

impl<I> fmt::Display for Named<I> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}
