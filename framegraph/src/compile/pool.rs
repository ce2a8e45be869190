//! Phase 8 for back ends without placed resources: resources of one shape share physical textures and buffers.
//!
//! A shape consists of the creation parameters without the sRGB transfer function, because view formats allow both
//! variants. The usage of a slot is the union of the usages of its resources.
//!
//! Within a shape, lifetimes are intervals. Each resource, in order of its first step, gets the most recently freed
//! slot. The number of slots then equals the maximum number of live resources, so the pool is provably optimal for its
//! kind.

use super::layout::Layout;
use super::measure::Measured;
use super::memory::MemoryStats;
use crate::access::Usage;
use crate::decision::{Decision, Reason, Subject};
use crate::format::Format;
use crate::graph::Tables;
use crate::id::{ResourceId, SlotId, StepId};
use crate::plan::{Memory, Placement, Planned, Slot};
use crate::resource::{Desc, Extent, TextureDesc};
use framegraph_pack::classes::{Classes, NIL};

/// Memory of the phase, reused between compilations.
#[derive(Debug, Default)]
pub(crate) struct PoolScratch {
    classes: Classes,
    /// Parallel to the resources.
    tenants: Vec<SharedResource>,
    /// Indexed by step.
    lists: Vec<Lists>,
    /// Parallel to the slots.
    slot_states: Vec<SlotState>,
}

/// A resource that shares memory.
#[derive(Clone, Copy, Debug)]
struct SharedResource {
    /// The next resource that starts in the same step; once the resource has started, its slot.
    start: u32,
    /// The next resource that ends in the same step.
    end: u32,
    /// Index of its shape; [`NIL`] if nothing is shared.
    class: u32,
    /// Index of its format.
    format: u8,
}

/// Heads of the lists of resources that start and end in a step. Linked through [`SharedResource`], ordered by id.
#[derive(Clone, Copy, Debug)]
struct Lists {
    start: u32,
    end: u32,
}

/// The state of a slot.
#[derive(Clone, Copy, Debug)]
struct SlotState {
    /// Its last user.
    last: ResourceId,
    /// The next free slot of its shape, while it is free.
    next_free: u32,
    /// All usages of its resources.
    usage: Usage,
    /// Format of its first resource, and the bits in which others differ.
    format: u8,
    mixed_formats: u8,
}

impl SlotState {
    /// Returns the state of a slot with its first resource.
    const fn first(last: ResourceId, row: &Planned, tenant: &SharedResource) -> Self {
        Self { last, next_free: NIL, usage: row.usage, format: tenant.format, mixed_formats: row.srgb_views as u8 }
    }
}

/// Returns `true` if a resource shares memory: used by a step and not placed yet.
fn takes_part(row: &Planned) -> bool {
    row.placement == Placement::Unused && !row.first.is_none()
}

/// Assigns a slot to every unplaced resource, each its own unless `share` is set. Returns the memory statistics.
#[inline(never)]
pub(crate) fn pool(
    graph: &Tables,
    measures: &[Measured],
    steps: usize,
    share: bool,
    scratch: &mut PoolScratch,
    resources: &mut [Planned],
    slots: &mut Vec<Slot>,
    decisions: &mut Vec<Decision>,
) -> Memory {
    slots.clear();
    let mut stats = MemoryStats::new();
    scratch.slot_states.clear();
    enlist(graph, measures, steps, share, resources, scratch, &mut stats);
    let PoolScratch { classes, tenants, lists, slot_states } = scratch;
    let alone = if share { Reason::SlotFirst } else { Reason::AliasingOff };
    // Equal lengths, so that one bounds check serves all arrays.
    let count = resources.len();
    let (tenants, declared, measures) = (&mut tenants[..count], &graph.resources[..count], &measures[..count]);
    for (step, heads) in lists.iter().enumerate() {
        let mut at = heads.start;
        while at != NIL {
            let resource = ResourceId::unchecked(at as usize);
            let (row, tenant) = (&mut resources[resource.index()], &mut tenants[resource.index()]);
            stats.begin(row.bytes);
            let (slot, reason) = match take_free(classes, tenant.class, slot_states) {
                Some((slot, state)) => {
                    state.usage = state.usage.union(row.usage);
                    state.mixed_formats |= (state.format ^ tenant.format) | u8::from(row.srgb_views);
                    (slot, Reason::SlotAfter(std::mem::replace(&mut state.last, resource)))
                }
                None => {
                    stats.take(row.bytes);
                    open_slot(&declared[resource.index()].desc, row, &measures[resource.index()], slots);
                    slot_states.push(SlotState::first(resource, row, tenant));
                    (slots.len() as u32 - 1, alone)
                }
            };
            row.placement = Placement::Slot(SlotId::unchecked(slot as usize));
            at = std::mem::replace(&mut tenant.start, slot);
            decisions.push(Decision { subject: Subject::Resource(resource), reason });
        }
        stats.begun(StepId::unchecked(step));
        let mut at = heads.end;
        while at != NIL {
            let SharedResource { start: slot, end, class, .. } = tenants[at as usize];
            stats.end(resources[at as usize].bytes);
            give_back(classes, class, slot, slot_states);
            at = end;
        }
    }
    for (slot, state) in slots.iter_mut().zip(slot_states) {
        (slot.usage, slot.srgb_views) = (state.usage, state.mixed_formats != 0);
    }
    stats.finish(steps, resources)
}

/// Lists the sharing resources by first and last step, with their shapes, and counts the others.
#[inline(never)]
fn enlist(
    graph: &Tables,
    measures: &[Measured],
    steps: usize,
    share: bool,
    resources: &[Planned],
    scratch: &mut PoolScratch,
    stats: &mut MemoryStats,
) {
    let PoolScratch { classes, tenants, lists, .. } = scratch;
    classes.clear();
    lists.clear();
    lists.resize(steps, Lists { start: NIL, end: NIL });
    tenants.resize(resources.len(), SharedResource { start: NIL, end: NIL, class: NIL, format: 0 });
    let rows = resources.iter().zip(measures).zip(&graph.resources).zip(tenants);
    for (index, (((row, measured), declared), tenant)) in rows.enumerate().rev() {
        if !takes_part(row) {
            stats.apart(declared.kind, row);
            continue;
        }
        let layout = match row.format {
            Some(format) => reformatted(measured.layout, format),
            None => measured.layout,
        };
        *tenant = SharedResource {
            start: std::mem::replace(&mut lists[row.first.index()].start, index as u32),
            end: std::mem::replace(&mut lists[row.last.index()].end, index as u32),
            class: if share { classes.of(measured.extent, layout.linear().bits()) } else { NIL },
            format: layout.format(),
        };
        stats.want(row.bytes);
    }
}

/// Returns the layout of a resource whose format was replaced by an inlined epilogue. Rarely called.
#[cold]
#[inline(never)]
fn reformatted(layout: Layout, format: Format) -> Layout {
    layout.with_format(format)
}

/// Adds a slot for its first resource, with absolute size and level count.
#[inline]
fn open_slot(declared: &Desc, row: &Planned, measured: &Measured, slots: &mut Vec<Slot>) {
    let (usage, bytes) = (row.usage, row.bytes);
    match declared {
        Desc::Texture(t) => {
            let [width, height] = measured.extent;
            let desc = Desc::Texture(TextureDesc {
                extent: Extent::Absolute { width, height },
                mips: measured.layout.mips(),
                format: row.format.unwrap_or(t.format),
                ..*t
            });
            slots.push(Slot { desc, usage, srgb_views: false, bytes });
        }
        Desc::Buffer(_) => slots.push(Slot { desc: *declared, usage, srgb_views: false, bytes }),
    }
}

/// Removes and returns the most recently freed slot of a shape.
#[inline]
fn take_free<'t>(
    classes: &mut Classes,
    class: u32,
    slot_states: &'t mut [SlotState],
) -> Option<(u32, &'t mut SlotState)> {
    let free = classes.free(class)?;
    let slot = *free;
    let state = slot_states.get_mut(slot as usize)?;
    *free = state.next_free;
    Some((slot, state))
}

/// Adds a slot to the free list of its shape.
#[inline]
fn give_back(classes: &mut Classes, class: u32, slot: u32, slot_states: &mut [SlotState]) {
    if let Some(free) = classes.free(class) {
        slot_states[slot as usize].next_free = std::mem::replace(free, slot);
    }
}
