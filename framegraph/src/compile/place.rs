//! Phase 8, before sharing: placement of resources that do not share memory.

use super::steps::{InlinedInto, is_inlined};
use crate::decision::{Decision, Reason, Subject};
use crate::graph::Tables;
use crate::id::ResourceId;
use crate::plan::{Placement, Planned};
use crate::resource::Kind;

/// Places imported, history and inlined resources, and logs unused ones. Exported and memoryless resources are placed
/// already.
#[inline(never)]
pub(crate) fn place(
    graph: &Tables,
    outside: &[ResourceId],
    inlined_into: &InlinedInto,
    resources: &mut [Planned],
    decisions: &mut Vec<Decision>,
) {
    for resource in outside {
        let imported = matches!(graph.resources[resource.index()].kind, Kind::Imported { .. });
        resources[resource.index()].placement = if imported { Placement::External } else { Placement::Own };
    }
    for (index, row) in resources.iter_mut().enumerate() {
        // Cannot overflow: there are at most as many resources as versions.
        let resource = ResourceId::unchecked(index);
        // Fast path: almost all resources share memory.
        if matches!(row.placement, Placement::Unused) && !row.first.is_none() {
            continue;
        }
        let reason = match row.placement {
            Placement::External => Reason::External,
            Placement::Own => Reason::Persistent,
            _ if !row.first.is_none() => continue,
            // No access of the plan refers to an inlined texture.
            _ if is_inlined(inlined_into, resource) => {
                row.placement = Placement::Inlined;
                Reason::Inlined
            }
            _ => graph.forward_of(resource).map_or(Reason::Unused, Reason::Forwarded),
        };
        decisions.push(Decision { subject: Subject::Resource(resource), reason });
    }
}
