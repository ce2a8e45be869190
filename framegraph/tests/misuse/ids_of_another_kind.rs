//! The id of a pass instead of a step, and the id of a resource instead of a pass.

use framegraph::{PassId, Plan, ResourceId};

fn report(plan: &Plan, pass: PassId, resource: ResourceId) {
    let _ = plan.passes_of(pass);
    let _ = plan.is_culled(resource);
}

fn main() {}
