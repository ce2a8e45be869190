//! Who shares memory with whom: tenants of one place take turns, and a slot fits all of its tenants.

use super::case::Case;
use super::finding::{Findings, Place, Rule};
use super::lifetimes::uses;
use super::memory::{Place as Where, images, place_of, reserved_bytes};
use crate::access::Usage;
use crate::id::{ResourceId, StepId};
use crate::options::Alias;
use crate::plan::Slot;
use crate::resource::{Desc, Extent, Kind, TextureDesc};
use std::collections::BTreeMap;

/// The shape with which a resource is created.
fn created(case: &Case<'_>, resource: ResourceId) -> Desc {
    match case.graph.resources()[resource.index()].desc {
        Desc::Buffer(buffer) => Desc::Buffer(buffer),
        Desc::Texture(texture) => {
            let frame = case.plan.frame();
            let [width, height] = texture.extent.resolve(frame);
            Desc::Texture(TextureDesc {
                extent: Extent::Absolute { width, height },
                mips: texture.mip_count(frame) as u8,
                format: case.format(resource).unwrap_or(texture.format),
                ..texture
            })
        }
    }
}

/// The shape without the sRGB transfer function of its format.
fn linear(desc: Desc) -> Desc {
    match desc {
        Desc::Texture(texture) => Desc::Texture(texture.format(texture.format.linear_twin())),
        buffer @ Desc::Buffer(_) => buffer,
    }
}

/// Tenants of one place, in the order of their first steps, must not be live at once; slots have the shape of the first
/// and the uses of all.
pub(super) fn tenants(case: &Case<'_>, findings: &mut Findings<'_>) {
    let life = |r: ResourceId| life(case, r);
    let mut tenants: Vec<_> = case
        .graph
        .resource_ids()
        .map(|r| (reserved(case, r), r))
        .filter(|(place, r)| matches!(place, Where::Slot(_) | Where::Bytes { .. }) && !life(*r).0.is_none())
        .collect();
    tenants.sort_by_key(|(_, r)| (life(*r), *r));
    let mut live: Vec<(Where, ResourceId)> = Vec::new();
    let mut of_slot = vec![Vec::new(); case.plan.slots().len()];
    for &(at, resource) in &tenants {
        live.retain(|(_, other)| life(*other).1 >= life(resource).0);
        for (_, other) in live.iter().filter(|(other, _)| overlap(*other, at)) {
            let name = case.graph.resource_name(*other);
            let sentence = format!("it is live at once with `{name}` in one place");
            findings.violation(Rule::Overlap, Place::resource(resource), sentence);
        }
        live.push((at, resource));
        if let Where::Slot(slot) = at {
            of_slot[slot].push(resource);
        }
    }
    for (index, (slot, tenants)) in case.plan.slots().iter().zip(&of_slot).enumerate() {
        examine_slot(case, index, slot, tenants, findings);
    }
}

/// From which step to which memory is needed. The images of a history are needed all the time, since which of them is
/// written rotates from frame to frame.
pub(super) fn life(case: &Case<'_>, resource: ResourceId) -> (StepId, StepId) {
    let row = &case.plan.resources()[resource.index()];
    match case.graph.resources()[resource.index()].kind {
        Kind::HistoryCurrent { .. } => {
            let last = case.plan.steps().len().checked_sub(1);
            last.map_or((row.first, row.last), |l| (StepId::at(0), StepId::at(l)))
        }
        _ => (row.first, row.last),
    }
}

/// The place of a resource with its padding; earlier images of a history are part of the ring of the current one.
pub(super) fn reserved(case: &Case<'_>, resource: ResourceId) -> Where {
    match (place_of(case.plan, resource), case.graph.resources()[resource.index()].kind) {
        (Where::Bytes { .. }, Kind::HistoryPrevious { .. }) => Where::None,
        (Where::Bytes { heap, start, .. }, _) => {
            let image = reserved_bytes(case.plan, resource);
            let bytes = image.saturating_mul(images(case.plan, resource));
            let end = start.saturating_add(bytes);
            Where::Bytes { heap, start, end }
        }
        (place, _) => place,
    }
}

/// Whether two places have memory in common.
pub(super) fn overlap(a: Where, b: Where) -> bool {
    match (a, b) {
        (Where::Slot(a), Where::Slot(b)) => a == b,
        (Where::Bytes { heap: a, start: a0, end: a1 }, Where::Bytes { heap: b, start: b0, end: b1 }) => {
            a == b && a0 < b1 && b0 < a1
        }
        _ => false,
    }
}

fn examine_slot(case: &Case<'_>, index: usize, slot: &Slot, tenants: &[ResourceId], findings: &mut Findings<'_>) {
    let Some(first) = tenants.first() else {
        let sentence = format!("slot {index} has no tenant");
        return findings.violation(Rule::Slot, Place::default(), sentence);
    };
    let place = Place::resource(*first);
    findings.equal(slot.desc, created(case, *first), Rule::Slot, place, "its slot's shape");
    let bytes = case.plan.resources()[first.index()].bytes;
    findings.equal(slot.bytes, bytes, Rule::Slot, place, "its slot's bytes");
    let alone = case.plan.options().alias == Alias::Off;
    findings.require(!alone || tenants.len() == 1, Rule::Slot, place, || {
        "its slot is shared, and sharing is switched off".into()
    });
    let (mut usage, mut twins) = (Usage::NONE, false);
    for &tenant in tenants {
        let desc = created(case, tenant);
        let (own, shared) = (linear(desc), linear(slot.desc));
        findings.equal(own, shared, Rule::Slot, Place::resource(tenant), "its shape in its slot");
        usage = usage.union(case.plan.resources()[tenant.index()].usage);
        twins |= desc != slot.desc;
    }
    uses(slot.usage, usage, place, findings);
    findings.equal(slot.srgb_twins, twins, Rule::Slot, place, "its slot's sRGB twins");
}

/// Who had the memory of each tenant before it.
pub(super) struct Heritage {
    owners: Vec<Vec<ResourceId>>,
}

impl Heritage {
    /// The tenants that had a part of the memory of `resource` when it came.
    pub(super) fn of(&self, resource: ResourceId) -> &[ResourceId] {
        &self.owners[resource.index()]
    }
}

/// For each tenant of shared memory, who had a part of it when it came. In the order of first use.
pub(super) fn heritage(case: &Case<'_>) -> Heritage {
    let row = |r: ResourceId| &case.plan.resources()[r.index()];
    let mut tenants: Vec<ResourceId> = case.graph.resource_ids().collect();
    let transient = |r: &ResourceId| case.graph.resources()[r.index()].kind == Kind::Transient;
    tenants.retain(|r| transient(r) && !row(*r).first.is_none());
    tenants.sort_by_key(|r| (row(*r).first, *r));
    let mut heritage = Heritage { owners: vec![Vec::new(); case.graph.resources().len()] };
    // Ranges by place and first byte: end and owner. They do not overlap.
    let mut owned: BTreeMap<(usize, u64), (u64, ResourceId)> = BTreeMap::new();
    for tenant in tenants {
        let (place, start, end) = match place_of(case.plan, tenant) {
            Where::Slot(slot) => (2 + slot, 0, 1),
            Where::Bytes { heap, start, end } => (usize::from(heap), start, end),
            Where::None | Where::Alone => continue,
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
            let owners = &mut heritage.owners[tenant.index()];
            if !owners.contains(&owner) {
                owners.push(owner);
            }
        }
        owned.insert((place, start), (end, tenant));
    }
    heritage
}
