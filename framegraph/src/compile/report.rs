//! Errors of the graph as a whole, with the names and places of what they concern.

use super::error::{CompileError, CompileReason};
use crate::graph::Tables;
use crate::id::{PassId, ResourceId};

/// An error that concerns this pass and this resource; none for either when there is none.
#[cold]
pub(crate) fn error(graph: &Tables, reason: CompileReason, pass: PassId, resource: ResourceId) -> CompileError {
    CompileError {
        reason,
        pass: pass.some().map(|p| graph.pass_name(p).to_owned()).unwrap_or_default(),
        resource: resource.some().map(|r| graph.resource_name(r).to_owned()).unwrap_or_default(),
        location: pass.some().map(|p| graph.passes[p.index()].location),
    }
}
