//! Rows on resources: where each lives, and why an attachment of one step takes memory all the same.

use super::{number, untrue};
use crate::access::Usage;
use crate::check::case::Case;
use crate::check::finding::{Findings, Place};
use crate::decision::{MemoryNeed, Reason};
use crate::id::ResourceId;
use crate::options::Alias;
use crate::plan::{Attachment, LoadOp, Placement, Planned, Role, StoreOp};
use crate::resource::{Dimension, Kind};

/// One row on the placement, and one on the need of memory where an attachment of one step has it.
pub(super) fn places(
    case: &Case<'_>,
    resource: ResourceId,
    before: &[ResourceId],
    reasons: &[Reason],
    findings: &mut Findings<'_>,
) {
    let row = &case.plan.resources()[resource.index()];
    let place = Place::resource(resource);
    let (mut placements, mut needs) = (0, 0);
    for &reason in reasons {
        let holds = match reason {
            Reason::NeedsMemory(why) => {
                needs += 1;
                row.placement != Placement::Memoryless && needs_memory(case, resource, row, why)
            }
            _ => {
                placements += 1;
                placed(case, resource, row, latest(case, before), reason)
            }
        };
        if !holds {
            untrue(findings, case, place, reason);
        }
    }
    number(findings, place, "its placement", placements, 1);
    let of_one_step = attached(case, resource, row).count();
    let memoryless = row.placement == Placement::Memoryless;
    let expected = if memoryless { 0 } else { of_one_step };
    number(findings, place, "its need of memory", needs, expected);
}

/// The attachments of a transient resource that lives in one step.
fn attached<'p>(case: &Case<'p>, resource: ResourceId, row: &Planned) -> impl Iterator<Item = &'p Attachment> {
    let transient = case.graph.resources()[resource.index()].kind == Kind::Transient;
    let one_step = transient && row.first == row.last;
    let step = row.first.some().filter(|_| one_step);
    let rows = step.map_or(&[][..], |s| case.plan.attachments_of(s));
    rows.iter().filter(move |a| a.resource == resource)
}

fn placed(case: &Case<'_>, resource: ResourceId, row: &Planned, before: Option<ResourceId>, reason: Reason) -> bool {
    let graph = case.graph;
    let slot = matches!(row.placement, Placement::Slot(_));
    let heap = matches!(row.placement, Placement::Heap { .. });
    let shared = case.plan.options().alias != Alias::Off;
    match reason {
        Reason::Memoryless(step) => row.placement == Placement::Memoryless && step == row.first,
        Reason::Inlined => row.placement == Placement::Inlined,
        Reason::SlotFirst => slot && shared && before.is_none(),
        Reason::SlotAfter(other) => slot && shared && before == Some(other),
        Reason::Placed => heap && !history(case, resource) && before.is_none(),
        Reason::PlacedAfter(other) => heap && before == Some(other),
        Reason::External => matches!(graph.resources()[resource.index()].kind, Kind::Imported { .. }),
        Reason::Persistent => row.placement == Placement::Own || heap && history(case, resource),
        Reason::AliasingOff => slot && !shared,
        Reason::Unused => row.placement == Placement::Unused,
        _ => false,
    }
}

fn history(case: &Case<'_>, resource: ResourceId) -> bool {
    let kind = case.graph.resources()[resource.index()].kind;
    matches!(kind, Kind::HistoryCurrent { .. } | Kind::HistoryPrevious { .. })
}

/// The one of the tenants before that had the memory last.
fn latest(case: &Case<'_>, before: &[ResourceId]) -> Option<ResourceId> {
    let last = |r: &&ResourceId| (case.plan.resources()[r.index()].last, **r);
    before.iter().max_by_key(last).copied()
}

/// Whether that is a reason for an attachment of one step to take memory.
fn needs_memory(case: &Case<'_>, resource: ResourceId, row: &Planned, why: MemoryNeed) -> bool {
    let (caps, options) = (case.plan.caps(), case.plan.options());
    let texture = case.graph.resources()[resource.index()].desc.texture();
    let mut rows = attached(case, resource, row);
    match why {
        MemoryNeed::Unsupported => !caps.memoryless || !options.memoryless,
        MemoryNeed::OtherUse => {
            let inside = Usage::ATTACHMENT.union(Usage::INPUT_ATTACHMENT);
            !row.usage.without(inside).is_empty()
        }
        MemoryNeed::ResolveTarget => rows.any(|a| matches!(a.role, Role::Resolve(_))),
        MemoryNeed::SeveralParts => {
            texture.is_some_and(|t| t.mips != 1 || t.layers != 1 || t.dimension != Dimension::D2)
        }
        MemoryNeed::LoadedOrStored => {
            case.exported[resource.index()]
                || rows.any(|a| {
                    let kept = |op: StoreOp| op == StoreOp::Store;
                    let load = |op: LoadOp| op == LoadOp::Load;
                    kept(a.store) || kept(a.stencil_store) || load(a.load) || load(a.stencil_load)
                })
        }
        MemoryNeed::ReadOnly => rows.any(|a| a.role == Role::DepthReadOnly),
    }
}
