//! The number of a pass where that of a step is wanted, and that of a resource where that of a pass is.

use framegraph::{PassId, Plan, ResourceId};

fn report(plan: &Plan, pass: PassId, resource: ResourceId) {
    let _ = plan.passes_of(pass);
    let _ = plan.is_culled(resource);
}

fn main() {}
