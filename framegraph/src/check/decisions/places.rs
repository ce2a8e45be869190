//! Rows on resources: where each lives, and why an attachment of one step takes memory all the same.

use super::{number, untrue};
use crate::access::Usage;
use crate::check::case::Case;
use crate::check::finding::{Findings, Place};
use crate::check::memory::place_of;
use crate::check::tenants::overlap;
use crate::decision::{MemoryNeed, Reason};
use crate::id::ResourceId;
use crate::options::Alias;
use crate::plan::{Attachment, LoadOp, Placement, Planned, Role, StoreOp};
use crate::resource::{Dimension, Kind};

/// One row on the placement, and one on the need of memory where an attachment of one step has it.
pub(super) fn places(case: &Case<'_>, resource: ResourceId, reasons: &[Reason], findings: &mut Findings<'_>) {
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
                placed(case, resource, row, reason)
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

fn placed(case: &Case<'_>, resource: ResourceId, row: &Planned, reason: Reason) -> bool {
    let graph = case.graph;
    let slot = matches!(row.placement, Placement::Slot(_));
    let heap = matches!(row.placement, Placement::Heap { .. });
    let shared = case.plan.options().alias != Alias::Off;
    match reason {
        Reason::Memoryless(step) => row.placement == Placement::Memoryless && step == row.first,
        Reason::Inlined => row.placement == Placement::Inlined,
        Reason::SlotFirst => slot && shared && before(case, resource).is_none(),
        Reason::SlotAfter(other) => slot && shared && before(case, resource) == Some(other),
        Reason::Placed => heap && !history(case, resource) && before(case, resource).is_none(),
        Reason::PlacedAfter(other) => heap && before(case, resource) == Some(other),
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

/// Whether `other` had memory of `resource` and was dead when it began.
fn is_before(case: &Case<'_>, resource: ResourceId, other: ResourceId) -> bool {
    let life = |r: ResourceId| &case.plan.resources()[r.index()];
    let overlaps = overlap(place_of(case.plan, resource), place_of(case.plan, other));
    let dead = !life(other).last.is_none() && life(other).last < life(resource).first;
    other != resource && overlaps && dead
}

/// The resource that had the memory of `resource` last.
fn before(case: &Case<'_>, resource: ResourceId) -> Option<ResourceId> {
    let ids = case.graph.resource_ids();
    ids.filter(|other| is_before(case, resource, *other))
        .max_by_key(|other| (case.plan.resources()[other.index()].last, *other))
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
