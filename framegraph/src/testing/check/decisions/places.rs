//! Rows about resources: placement, and reasons why an attachment of a single step needs memory.

use super::rows::{judge, number};
use crate::access::Usage;
use crate::decision::{MemoryNeed, Reason};
use crate::id::ResourceId;
use crate::options::Alias;
use crate::plan::{Attachment, LoadOp, Placement, StoreOp};
use crate::resource::{Dimension, Kind, TextureDesc};
use crate::testing::check::case::Case;
use crate::testing::check::resolves::is_target;

/// Checks the row about the placement, and the row about the need for memory if the resource is an attachment of a
/// single step.
pub(super) fn places(case: &Case<'_>, resource: ResourceId, earlier: &[ResourceId], reasons: &[Reason]) {
    let memoryless = case.placement(resource) == Placement::Memoryless;
    // The last of the earlier resources in the same memory.
    let before = earlier.iter().max_by_key(|r| (case.planned(**r).last, **r)).copied();
    let mut needs = 0;
    for &reason in reasons {
        let holds = if let Reason::NeedsMemory(why) = reason {
            needs += 1;
            !memoryless && needs_memory(case, resource, why)
        } else {
            placed(case, resource, before, reason)
        };
        judge(case, resource, reason, holds);
    }
    number(case, resource, "its placement", reasons.len() - needs, 1);
    let expected = if memoryless { 0 } else { attached(case, resource).count() };
    number(case, resource, "its need for memory", needs, expected);
}

/// Returns the attachments of a transient resource that is used in a single step.
fn attached<'p>(case: &Case<'p>, resource: ResourceId) -> impl Iterator<Item = &'p Attachment> {
    let row = case.planned(resource);
    let one_step = case.kind(resource) == Kind::Transient && row.first == row.last;
    let step = row.first.some().filter(|_| one_step);
    let rows = step.map_or(&[][..], |s| case.plan.attachments_of(s));
    rows.iter().filter(move |a| a.resource == resource)
}

fn placed(case: &Case<'_>, resource: ResourceId, before: Option<ResourceId>, reason: Reason) -> bool {
    let row = case.planned(resource);
    let slot = matches!(row.placement, Placement::Slot(_));
    let heap = matches!(row.placement, Placement::Heap { .. });
    let shared = case.plan.options().alias != Alias::Off;
    let kind = case.kind(resource);
    let history = matches!(kind, Kind::HistoryCurrent { .. } | Kind::HistoryPrevious { .. });
    match reason {
        Reason::Memoryless(step) => row.placement == Placement::Memoryless && step == row.first,
        Reason::Inlined => row.placement == Placement::Inlined,
        Reason::SlotFirst => slot && shared && before.is_none(),
        Reason::SlotAfter(other) => slot && shared && before == Some(other),
        Reason::Placed => heap && !history && before.is_none(),
        Reason::PlacedAfter(other) => heap && before == Some(other),
        Reason::External => matches!(kind, Kind::Imported { .. }),
        Reason::Persistent => row.placement == Placement::Own || heap && history,
        Reason::AliasingOff => slot && !shared,
        Reason::Unused => row.placement == Placement::Unused && case.graph.forward_of(resource).is_none(),
        Reason::Forwarded(to) => row.placement == Placement::Unused && case.graph.forward_of(resource) == Some(to),
        _ => false,
    }
}

/// Returns `true` if the reason for an attachment of a single step to need memory is correct.
fn needs_memory(case: &Case<'_>, resource: ResourceId, why: MemoryNeed) -> bool {
    let mut rows = attached(case, resource);
    match why {
        MemoryNeed::Unsupported => !case.plan.caps().memoryless || !case.plan.options().memoryless,
        MemoryNeed::OtherUse => {
            let inside = Usage::ATTACHMENT.union(Usage::INPUT_ATTACHMENT);
            !case.planned(resource).usage.without(inside).is_empty()
        }
        MemoryNeed::ResolveTarget => rows.any(|a| is_target(a.role)),
        MemoryNeed::SeveralParts => {
            let layers = case.plan.caps().memoryless_layers;
            let several = |t: &TextureDesc| t.mips != 1 || t.layers != 1 && !layers || t.dimension != Dimension::D2;
            case.texture(resource).is_some_and(several)
        }
        MemoryNeed::LoadedOrStored => {
            let loads = |a: &Attachment| a.load == LoadOp::Load || a.stencil_load == LoadOp::Load;
            let stores = |a: &Attachment| a.store == StoreOp::Store || a.stencil_store == StoreOp::Store;
            case.exported[resource.index()] || rows.any(|a| loads(a) || stores(a))
        }
    }
}
