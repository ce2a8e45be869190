//! Checks shared memory: resources in one region have disjoint lifetimes, and a slot fits all its resources.

use super::finding::Rule;
use super::lifetimes::uses;
use super::memory::{Region, images, region_of, reserved_bytes};
use super::rule_input::RuleInput;
use framegraph::access::Usage;
use framegraph::id::{ResourceId, StepId};
use framegraph::options::Alias;
use framegraph::plan::Slot;
use framegraph::resource::{Desc, Extent, Kind, TextureDesc};
use std::collections::BTreeMap;

/// Returns the descriptor used to create a resource.
fn created(ctx: &RuleInput<'_>, resource: ResourceId) -> Desc {
    match ctx.graph.resources()[resource.index()].desc {
        Desc::Buffer(buffer) => Desc::Buffer(buffer),
        Desc::Texture(texture) => {
            let frame = ctx.plan.frame();
            let [width, height] = texture.extent.texels(frame);
            Desc::Texture(TextureDesc {
                extent: Extent::Absolute { width, height },
                mips: texture.mip_count(frame) as u8,
                format: ctx.format(resource).unwrap_or(texture.format),
                ..texture
            })
        }
    }
}

/// Returns the descriptor without the sRGB transfer function of its format.
pub(super) fn without_srgb(desc: Desc) -> Desc {
    match desc {
        Desc::Texture(texture) => Desc::Texture(texture.format(texture.format.without_srgb())),
        buffer @ Desc::Buffer(_) => buffer,
    }
}

/// Checks that resources in one region are not live at the same time. Slots must have the shape of their first resource
/// and the usages of all.
pub(super) fn tenants(ctx: &RuleInput<'_>) {
    let life = |r: ResourceId| life(ctx, r);
    let shares = |region: &Region| matches!(region, Region::Slot(_) | Region::Bytes { .. });
    let all = ctx.graph.resource_ids().map(|r| (reserved(ctx, r), r));
    let mut tenants: Vec<_> = all.filter(|(region, r)| shares(region) && !life(*r).0.is_none()).collect();
    tenants.sort_by_key(|(_, r)| (life(*r), *r));
    let mut live: Vec<(Region, ResourceId)> = Vec::new();
    let mut of_slot = vec![Vec::new(); ctx.plan.slots().len()];
    for &(region, resource) in &tenants {
        live.retain(|(_, other)| life(*other).1 >= life(resource).0);
        for (_, other) in live.iter().filter(|(other, _)| overlap(*other, region)) {
            let name = ctx.graph.resource_name(*other);
            let why = format_args!("it is live at the same time as `{name}` in the same memory");
            ctx.report.violation(Rule::Overlap, resource, why);
        }
        live.push((region, resource));
        if let Region::Slot(slot) = region {
            of_slot[slot].push(resource);
        }
    }
    for (index, (slot, tenants)) in ctx.plan.slots().iter().zip(&of_slot).enumerate() {
        examine_slot(ctx, index, slot, tenants);
    }
}

/// Returns the first and last step in which memory is needed. Histories need it during the whole frame, because the
/// written image changes from frame to frame.
pub(super) fn life(ctx: &RuleInput<'_>, resource: ResourceId) -> (StepId, StepId) {
    let row = ctx.planned(resource);
    match (ctx.kind(resource), ctx.plan.steps().len().checked_sub(1)) {
        (Kind::HistoryCurrent { .. }, Some(last)) => (StepId::at(0), StepId::at(last)),
        _ => (row.first, row.last),
    }
}

/// Returns the region of a resource with padding. Earlier history images are part of the current one's region.
pub(super) fn reserved(ctx: &RuleInput<'_>, resource: ResourceId) -> Region {
    match (region_of(ctx.plan, resource), ctx.kind(resource)) {
        (Region::Bytes { .. }, Kind::HistoryPrevious { .. }) => Region::None,
        (Region::Bytes { heap, start, .. }, _) => {
            let bytes = reserved_bytes(ctx.plan, resource).saturating_mul(images(ctx.plan, resource));
            Region::Bytes { heap, start, end: start.saturating_add(bytes) }
        }
        (region, _) => region,
    }
}

/// Returns `true` if two regions overlap.
fn overlap(a: Region, b: Region) -> bool {
    match (a, b) {
        (Region::Slot(a), Region::Slot(b)) => a == b,
        (Region::Bytes { heap: a, start: a0, end: a1 }, Region::Bytes { heap: b, start: b0, end: b1 }) => {
            a == b && a0 < b1 && b0 < a1
        }
        _ => false,
    }
}

fn examine_slot(ctx: &RuleInput<'_>, index: usize, slot: &Slot, tenants: &[ResourceId]) {
    let Some(&first) = tenants.first() else {
        return ctx.report.violation(Rule::Slot, (), format_args!("slot {index} has no resource"));
    };
    ctx.report.equal(slot.desc, created(ctx, first), Rule::Slot, first, "its slot's shape");
    ctx.report.equal(slot.bytes, ctx.planned(first).bytes, Rule::Slot, first, "its slot's bytes");
    let alone = ctx.plan.options().alias != Alias::Off || tenants.len() == 1;
    ctx.report.require(alone, Rule::Slot, first, "its slot is shared, but aliasing is disabled");
    let (mut usage, mut views) = (Usage::NONE, false);
    for &tenant in tenants {
        let desc = created(ctx, tenant);
        let (own, shared) = (without_srgb(desc), without_srgb(slot.desc));
        ctx.report.equal(own, shared, Rule::Slot, tenant, "its shape in its slot");
        usage = usage.union(ctx.planned(tenant).usage);
        views |= desc != slot.desc || ctx.planned(tenant).srgb_views;
    }
    uses(ctx, slot.usage, usage, first.into());
    ctx.report.equal(slot.srgb_views, views, Rule::Slot, first, "its slot's sRGB views");
}

/// By resource: the previous resources in its memory, ordered by offset. Empty for resources that do not share memory.
pub(super) type EarlierTenants = Vec<Vec<ResourceId>>;

/// Returns the previous resources in the memory of every resource.
pub(super) fn earlier_tenants(ctx: &RuleInput<'_>) -> EarlierTenants {
    let row = |r: ResourceId| ctx.planned(r);
    let mut tenants: Vec<ResourceId> = ctx.graph.resource_ids().collect();
    tenants.retain(|r| ctx.kind(*r) == Kind::Transient && !row(*r).first.is_none());
    tenants.sort_by_key(|r| (row(*r).first, *r));
    let mut earlier = vec![Vec::new(); ctx.graph.resources().len()];
    // Ranges by region and first byte: end and owner. They do not overlap.
    let mut owned: BTreeMap<(usize, u64), (u64, ResourceId)> = BTreeMap::new();
    for tenant in tenants {
        let (place, start, end) = match region_of(ctx.plan, tenant) {
            Region::Slot(slot) => (2 + slot, 0, 1),
            Region::Bytes { heap, start, end } => (usize::from(heap), start, end),
            Region::None | Region::Alone => continue,
        };
        let inside = owned.range((place, 0)..(place, end));
        let hit: Vec<_> = inside.filter(|(_, (last, _))| *last > start).map(|(k, v)| (*k, *v)).collect();
        for (key, (last, owner)) in hit {
            owned.remove(&key);
            if key.1 < start {
                owned.insert(key, (start, owner));
            }
            if last > end {
                owned.insert((place, end), (last, owner));
            }
            let owners: &mut Vec<ResourceId> = &mut earlier[tenant.index()];
            if !owners.contains(&owner) {
                owners.push(owner);
            }
        }
        owned.insert((place, start), (end, tenant));
    }
    earlier
}
