//! Phase 8 for back ends with placed resources: byte ranges of a heap, shared by resources of any shape.
//!
//! Each transient resource is an interval of steps with a size; [`crate::pack`] chooses the offsets. Sizes are rounded
//! up to the alignment of the device.
//!
//! The ring of a history is one item that lives during the whole frame. Its images are adjacent; the image that is
//! written changes from frame to frame. Textures and buffers use separate heaps if the device requires it.

use super::memory::MemoryStats;
use super::ownership::{Owned, take_over};
use crate::caps::Caps;
use crate::decision::{Decision, Reason, Subject};
use crate::graph::Tables;
use crate::id::{ResourceId, StepId};
use crate::options::Options;
use crate::pack::{self, Interval, pack};
use crate::plan::{Memory, Placement, Plan, Planned};
use crate::resource::Kind;

/// Memory of the phase, reused between compilations.
#[derive(Debug, Default)]
pub(crate) struct HeapScratch {
    items: Vec<Interval>,
    owners: Vec<ResourceId>,
    offsets: Vec<u64>,
    previous_of_items: Vec<Option<u64>>,
    /// Offsets in an earlier plan, by resource; empty if there is no earlier plan.
    pub(crate) previous: Vec<Option<u64>>,
    packing: pack::Scratch,
    /// Offsets by heap, applied once both heaps are packed.
    placed: [Vec<(ResourceId, u64)>; 2],
    /// Resources in the order of their first step, and the last user of each byte range, for the log.
    order: Vec<ResourceId>,
    owned: Vec<Owned>,
}

/// Places every unplaced resource and every written history, and returns the memory statistics. Returns `None` and
/// places nothing if sizes exceed 64 bits.
pub(crate) fn heap(
    graph: &Tables,
    caps: &Caps,
    options: &Options,
    steps: usize,
    scratch: &mut HeapScratch,
    resources: &mut [Planned],
    decisions: &mut Vec<Decision>,
) -> Option<Memory> {
    let mut sum = Memory { optimal: true, ..Memory::default() };
    let mut highest = 0;
    scratch.placed.iter_mut().for_each(Vec::clear);
    for buffers in [false, true] {
        if buffers && !caps.separate_heaps {
            break;
        }
        gather(graph, caps, options.frame, steps, buffers, scratch, resources);
        if scratch.items.is_empty() {
            continue;
        }
        let HeapScratch { items, owners, offsets, previous_of_items, previous, packing, placed, .. } = scratch;
        let keep = (!previous.is_empty()).then_some(previous_of_items.as_slice());
        let limits = pack::Options { effort: options.effort, budget_steps: options.budget_steps };
        let found = pack(items, keep, &limits, packing, offsets).ok()?;
        sum.bytes = sum.bytes.saturating_add(found.top);
        sum.lower_bound_bytes = sum.lower_bound_bytes.saturating_add(found.lower_bound);
        sum.unaliased_bytes = items.iter().fold(sum.unaliased_bytes, |sum, i| sum.saturating_add(i.size));
        sum.optimal &= found.optimal;
        if found.peak > highest {
            (highest, sum.peak) = (found.peak, StepId::at(found.peak_at as usize));
        }
        placed[usize::from(buffers)].extend(owners.iter().copied().zip(offsets.iter().copied()));
    }
    for (owner, offset) in scratch.placed.iter().flatten() {
        resources[owner.index()].placement = Placement::Heap { offset: *offset };
    }
    place_rings(graph, caps, resources);
    let mut stats = MemoryStats::new();
    graph.resources.iter().zip(&*resources).for_each(|(declared, row)| stats.apart(declared.kind, row));
    (sum.avoided_bytes, sum.own_bytes) = stats.apart_bytes();
    let HeapScratch { order, owned, .. } = scratch;
    log(graph, caps, resources, order, owned, decisions);
    Some(sum)
}

/// Collects the items of one heap.
fn gather(
    graph: &Tables,
    caps: &Caps,
    frame: [u32; 2],
    steps: usize,
    buffers: bool,
    scratch: &mut HeapScratch,
    resources: &mut [Planned],
) {
    let HeapScratch { items, owners, previous_of_items, previous, .. } = scratch;
    items.clear();
    owners.clear();
    previous_of_items.clear();
    for (index, row) in resources.iter_mut().enumerate() {
        let declared = &graph.resources[index];
        let unplaced = row.placement == Placement::Unused && !row.first.is_none();
        if unplaced && declared.kind == Kind::Transient {
            row.bytes = caps.padded_bytes(&declared.desc, row.format, frame, row.bytes);
        }
        let buffer = declared.desc.texture().is_none();
        if caps.separate_heaps && buffer != buffers {
            continue;
        }
        let align = alignment(caps, buffer);
        let size = row.bytes.checked_next_multiple_of(align).unwrap_or(u64::MAX);
        let (lower, upper, images) = match declared.kind {
            Kind::HistoryCurrent { frames } if caps.placed_histories && !row.first.is_none() => {
                (0, steps as u32, u64::from(frames) + 1)
            }
            Kind::Transient if unplaced => (row.first.index() as u32, row.last.index() as u32 + 1, 1),
            _ => continue,
        };
        items.push(Interval { lower, upper, size: size.saturating_mul(images), align });
        owners.push(ResourceId::at(index));
        previous_of_items.push(previous.get(index).copied().flatten());
    }
}

const fn alignment(caps: &Caps, buffer: bool) -> u64 {
    let bytes = if buffer { caps.buffer_alignment_bytes } else { caps.texture_alignment_bytes };
    if bytes == 0 { 1 } else { bytes }
}

/// Places the earlier images of histories behind the current one: an image of age `n` is `n` images further.
fn place_rings(graph: &Tables, caps: &Caps, resources: &mut [Planned]) {
    for index in 0..resources.len() {
        let Kind::HistoryPrevious { current, age } = graph.resources[index].kind else { continue };
        if let Placement::Heap { offset } = resources[current.index()].placement {
            let size = resources[current.index()].bytes.next_multiple_of(alignment(caps, false));
            resources[index].placement = Placement::Heap { offset: offset + size * u64::from(age) };
        }
    }
}

/// Logs for each placed resource whose memory it reuses: the latest resource that ends before it and overlaps it.
fn log(
    graph: &Tables,
    caps: &Caps,
    resources: &[Planned],
    order: &mut Vec<ResourceId>,
    owned: &mut Vec<Owned>,
    decisions: &mut Vec<Decision>,
) {
    let placed = |r: &ResourceId| matches!(resources[r.index()].placement, Placement::Heap { .. });
    let transient = |r: &ResourceId| graph.resources[r.index()].kind == Kind::Transient;
    order.clear();
    order.extend((0..resources.len()).map(ResourceId::at).filter(|r| placed(r) && transient(r)));
    order.sort_by_key(|r| (resources[r.index()].first, *r));
    owned.clear();
    for &resource in order.iter() {
        let row = &resources[resource.index()];
        let Placement::Heap { offset } = row.placement else { continue };
        let heap = caps.separate_heaps && graph.resources[resource.index()].desc.texture().is_none();
        let end = offset.saturating_add(row.bytes.max(1));
        let mut latest = None;
        take_over(owned, Owned { heap: heap.into(), start: offset, end, resource }, |previous| {
            latest = latest.max(Some((resources[previous.index()].last, previous)));
        });
        let reason = latest.map_or(Reason::Placed, |(_, previous)| Reason::PlacedAfter(previous));
        decisions.push(Decision { subject: Subject::Resource(resource), reason });
    }
}

/// Returns the offsets in an earlier plan for the resources of `graph`, matched by name.
pub(crate) fn remember(graph: &Tables, earlier: &Plan, previous: &mut Vec<Option<u64>>) {
    let mut names: Vec<(&str, u64)> = Vec::new();
    for resource in earlier.graph().resource_ids() {
        if let Placement::Heap { offset } = earlier.resources()[resource.index()].placement {
            names.push((earlier.graph().resource_name(resource), offset));
        }
    }
    names.sort_by_key(|(name, _)| *name);
    previous.clear();
    previous.extend(graph.resource_ids().map(|r| {
        let at = names.partition_point(|(name, _)| *name < graph.resource_name(r));
        names.get(at).filter(|(name, _)| *name == graph.resource_name(r)).map(|(_, offset)| *offset)
    }));
}
