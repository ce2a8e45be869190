//! Rows about resources: placement, and reasons why an attachment of a single step needs memory.

use super::rows::{judge, number};
use crate::check::resolves::is_target;
use crate::check::rule_input::RuleInput;
use framegraph::access::Usage;
use framegraph::decision::{MemoryNeed, Reason};
use framegraph::id::ResourceId;
use framegraph::options::Alias;
use framegraph::plan::{Attachment, LoadOp, Placement, StoreOp};
use framegraph::resource::{Dimension, Kind, TextureDesc};

/// Checks the row about the placement, and the row about the need for memory if the resource is an attachment of a
/// single step.
pub(super) fn places(ctx: &RuleInput<'_>, resource: ResourceId, earlier: &[ResourceId], reasons: &[Reason]) {
    let memoryless = ctx.placement(resource) == Placement::Memoryless;
    // The last of the earlier resources in the same memory.
    let before = earlier.iter().max_by_key(|r| (ctx.planned(**r).last, **r)).copied();
    let mut needs = 0;
    for &reason in reasons {
        let holds = if let Reason::NeedsMemory(why) = reason {
            needs += 1;
            !memoryless && needs_memory(ctx, resource, why)
        } else {
            placed(ctx, resource, before, reason)
        };
        judge(ctx, resource, reason, holds);
    }
    number(ctx, resource, "its placement", reasons.len() - needs, 1);
    let expected = if memoryless { 0 } else { attached(ctx, resource).count() };
    number(ctx, resource, "its need for memory", needs, expected);
}

/// Returns the attachments of a transient resource that is used in a single step.
fn attached<'p>(ctx: &RuleInput<'p>, resource: ResourceId) -> impl Iterator<Item = &'p Attachment> {
    let row = ctx.planned(resource);
    let one_step = ctx.kind(resource) == Kind::Transient && row.first == row.last;
    let step = row.first.some().filter(|_| one_step);
    let rows = step.map_or(&[][..], |s| ctx.plan.attachments_of(s));
    rows.iter().filter(move |a| a.resource == resource)
}

fn placed(ctx: &RuleInput<'_>, resource: ResourceId, before: Option<ResourceId>, reason: Reason) -> bool {
    let row = ctx.planned(resource);
    let slot = matches!(row.placement, Placement::Slot(_));
    let heap = matches!(row.placement, Placement::Heap { .. });
    let shared = ctx.plan.options().alias != Alias::Off;
    let kind = ctx.kind(resource);
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
        Reason::Unused => row.placement == Placement::Unused && ctx.graph.forward_of(resource).is_none(),
        Reason::Forwarded(to) => row.placement == Placement::Unused && ctx.graph.forward_of(resource) == Some(to),
        _ => false,
    }
}

/// Returns `true` if the reason for an attachment of a single step to need memory is correct.
fn needs_memory(ctx: &RuleInput<'_>, resource: ResourceId, why: MemoryNeed) -> bool {
    let mut rows = attached(ctx, resource);
    match why {
        MemoryNeed::Unsupported => !ctx.plan.caps().memoryless || !ctx.plan.options().memoryless,
        MemoryNeed::OtherUse => {
            let inside = Usage::ATTACHMENT.union(Usage::INPUT_ATTACHMENT);
            !ctx.planned(resource).usage.without(inside).is_empty()
        }
        MemoryNeed::ResolveTarget => rows.any(|a| is_target(a.role)),
        MemoryNeed::SeveralParts => {
            let layers = ctx.plan.caps().memoryless_layers;
            let several = |t: &TextureDesc| t.mips != 1 || t.layers != 1 && !layers || t.dimension != Dimension::D2;
            ctx.texture(resource).is_some_and(several)
        }
        MemoryNeed::NotSaved => !ctx.memoryless_saves(),
        MemoryNeed::View => ctx.planned(resource).srgb_views && !ctx.plan.caps().memoryless_views,
        MemoryNeed::LoadedOrStored => {
            let loads = |a: &Attachment| a.load == LoadOp::Load || a.stencil_load == LoadOp::Load;
            let stores = |a: &Attachment| a.store == StoreOp::Store || a.stencil_store == StoreOp::Store;
            ctx.exported[resource.index()] || rows.any(|a| loads(a) || stores(a))
        }
        _ => false,
    }
}
