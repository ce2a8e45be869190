//! Phase 8, before sharing: resources that take no part in it.

use super::inline::{InlinedInto, is_inlined};
use crate::decision::{Decision, Reason, Subject};
use crate::graph::Graph;
use crate::id::ResourceId;
use crate::plan::{Placement, Planned};
use crate::resource::Kind;

/// Places what is imported, of a history, or inlined; logs unused ones. Exported and memoryless ones are placed already.
pub(crate) fn place(
    graph: &Graph,
    inlined_into: &InlinedInto,
    resources: &mut [Planned],
    decisions: &mut Vec<Decision>,
) {
    for (index, row) in resources.iter_mut().enumerate() {
        let reason = match graph.resources[index].kind {
            Kind::Imported { .. } => {
                row.placement = Placement::External;
                Reason::External
            }
            Kind::HistoryCurrent { .. } | Kind::HistoryPrevious { .. } => {
                row.placement = Placement::Own;
                Reason::Persistent
            }
            Kind::Transient if row.placement == Placement::Own => Reason::Persistent,
            Kind::Transient if is_inlined(inlined_into, ResourceId::at(index)) => {
                row.placement = Placement::Inlined;
                Reason::Inlined
            }
            Kind::Transient if row.first.is_none() => Reason::Unused,
            Kind::Transient => continue,
        };
        decisions.push(Decision { subject: Subject::Resource(ResourceId::at(index)), reason });
    }
}
