//! Phase 8, before sharing: resources that take no part in it.

use super::steps::{InlinedInto, is_inlined};
use crate::decision::{Decision, Reason, Subject};
use crate::graph::Tables;
use crate::id::ResourceId;
use crate::plan::{Placement, Planned};
use crate::resource::Kind;

/// Places what is imported, of a history, or inlined; logs unused ones. Exported and memoryless ones are placed already.
#[inline(never)]
pub(crate) fn place(
    graph: &Tables,
    inlined_into: &InlinedInto,
    resources: &mut [Planned],
    decisions: &mut Vec<Decision>,
) {
    for (index, (row, declared)) in resources.iter_mut().zip(&graph.resources).enumerate() {
        // There are no more resources than versions, and those were counted.
        let resource = ResourceId::unchecked(index);
        let inlined = || is_inlined(inlined_into, resource);
        let is_transient = matches!(declared.kind, Kind::Transient);
        if is_transient && row.placement != Placement::Own && !row.first.is_none() && !inlined() {
            continue;
        }
        let reason = match declared.kind {
            Kind::Imported { .. } => {
                row.placement = Placement::External;
                Reason::External
            }
            Kind::HistoryCurrent { .. } | Kind::HistoryPrevious { .. } => {
                row.placement = Placement::Own;
                Reason::Persistent
            }
            Kind::Transient if row.placement == Placement::Own => Reason::Persistent,
            Kind::Transient if inlined() => {
                row.placement = Placement::Inlined;
                Reason::Inlined
            }
            Kind::Transient => graph.forward_of(resource).map_or(Reason::Unused, Reason::Forwarded),
        };
        decisions.push(Decision { subject: Subject::Resource(resource), reason });
    }
}
