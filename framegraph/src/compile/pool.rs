//! Phase 8 on back ends without placed resources: resources of one shape take turns in physical textures.
//!
//! A shape is what a texture is created with, the sRGB transfer function aside (two formats that differ only in it share
//! memory through view formats); uses are united. Within one shape, lifetimes are intervals, and giving each resource the
//! slot that was freed last, in the order of first use, needs as many slots as are ever live at once: no assignment needs
//! fewer. So the pool is optimal for its kind, and proved so.

use super::layout::Layout;
use super::measure::Measured;
use super::memory::Tally;
use crate::access::Usage;
use crate::decision::{Decision, Reason, Subject};
use crate::format::Format;
use crate::graph::Tables;
use crate::id::{ResourceId, SlotId, StepId};
use crate::plan::{Memory, Placement, Planned, Slot};
use crate::resource::{Desc, Extent, TextureDesc};
use framegraph_pack::classes::{Classes, NIL};

/// Memory of the phase, kept between compiles.
#[derive(Debug, Default)]
pub(crate) struct PoolScratch {
    classes: Classes,
    /// Parallel to the resources.
    tenants: Vec<Tenant>,
    /// By step.
    lists: Vec<Lists>,
    /// Parallel to the slots.
    tenancies: Vec<Tenancy>,
}

/// A resource that takes part in sharing.
#[derive(Clone, Copy, Debug)]
struct Tenant {
    /// The next resource that starts in the same step; once the resource has started, its slot.
    start: u32,
    /// The next resource that ends in the same step.
    end: u32,
    /// The number of its shape; [`NIL`] when nothing is shared.
    class: u32,
    /// The number of its format.
    format: u8,
}

/// The first resources that start and end in a step; lists go on in [`Tenant`], in the order of ids.
#[derive(Clone, Copy, Debug)]
struct Lists {
    start: u32,
    end: u32,
}

/// How a slot is used.
#[derive(Clone, Copy, Debug)]
struct Tenancy {
    /// The resource that had it last.
    last: ResourceId,
    /// The next free slot of its shape, while it is free.
    next_free: u32,
    /// Every use by any tenant.
    usage: Usage,
    /// The format of its first tenant, and the bits in which another's differs.
    format: u8,
    mixed_formats: u8,
}

impl Tenancy {
    /// That of a slot's first tenant.
    const fn first(last: ResourceId, row: &Planned, tenant: &Tenant) -> Self {
        Self { last, next_free: NIL, usage: row.usage, format: tenant.format, mixed_formats: row.srgb_views as u8 }
    }
}

/// Whether a resource takes part in sharing: touched, not placed yet (memoryless, own, external), and wanted.
fn takes_part(row: &Planned) -> bool {
    row.placement == Placement::Unused && !row.first.is_none()
}

/// Gives every resource that is still unplaced a slot, `share` off each its own, and sums up the memory.
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
    let mut tally = Tally::new();
    scratch.tenancies.clear();
    enlist(graph, measures, steps, share, resources, scratch, &mut tally);
    let PoolScratch { classes, tenants, lists, tenancies } = scratch;
    let alone = if share { Reason::SlotFirst } else { Reason::AliasingOff };
    // Rows of one resource: one check of its number serves for all.
    let count = resources.len();
    let (tenants, declared, measures) = (&mut tenants[..count], &graph.resources[..count], &measures[..count]);
    for (step, heads) in lists.iter().enumerate() {
        let mut at = heads.start;
        while at != NIL {
            let resource = ResourceId::unchecked(at as usize);
            let (row, tenant) = (&mut resources[resource.index()], &mut tenants[resource.index()]);
            tally.begin(row.bytes);
            let (slot, reason) = match take_free(classes, tenant.class, tenancies) {
                Some((slot, tenancy)) => {
                    tenancy.usage = tenancy.usage.union(row.usage);
                    tenancy.mixed_formats |= (tenancy.format ^ tenant.format) | u8::from(row.srgb_views);
                    (slot, Reason::SlotAfter(std::mem::replace(&mut tenancy.last, resource)))
                }
                None => {
                    tally.take(row.bytes);
                    open_slot(&declared[resource.index()].desc, row, &measures[resource.index()], slots);
                    tenancies.push(Tenancy::first(resource, row, tenant));
                    (slots.len() as u32 - 1, alone)
                }
            };
            row.placement = Placement::Slot(SlotId::unchecked(slot as usize));
            at = std::mem::replace(&mut tenant.start, slot);
            decisions.push(Decision { subject: Subject::Resource(resource), reason });
        }
        tally.begun(StepId::unchecked(step));
        let mut at = heads.end;
        while at != NIL {
            let Tenant { start: slot, end, class, .. } = tenants[at as usize];
            tally.end(resources[at as usize].bytes);
            give_back(classes, class, slot, tenancies);
            at = end;
        }
    }
    for (slot, tenancy) in slots.iter_mut().zip(tenancies) {
        (slot.usage, slot.srgb_views) = (tenancy.usage, tenancy.mixed_formats != 0);
    }
    tally.finish(steps, resources)
}

/// Lists what takes part by first and by last step, with its shape, and counts the rest.
#[inline(never)]
fn enlist(
    graph: &Tables,
    measures: &[Measured],
    steps: usize,
    share: bool,
    resources: &[Planned],
    scratch: &mut PoolScratch,
    tally: &mut Tally,
) {
    let PoolScratch { classes, tenants, lists, .. } = scratch;
    classes.clear();
    lists.clear();
    lists.resize(steps, Lists { start: NIL, end: NIL });
    tenants.resize(resources.len(), Tenant { start: NIL, end: NIL, class: NIL, format: 0 });
    let rows = resources.iter().zip(measures).zip(&graph.resources).zip(tenants);
    for (index, (((row, measured), declared), tenant)) in rows.enumerate().rev() {
        if !takes_part(row) {
            tally.apart(declared.kind, row);
            continue;
        }
        let layout = match row.format {
            Some(format) => reformatted(measured.layout, format),
            None => measured.layout,
        };
        *tenant = Tenant {
            start: std::mem::replace(&mut lists[row.first.index()].start, index as u32),
            end: std::mem::replace(&mut lists[row.last.index()].end, index as u32),
            class: if share { classes.of(measured.extent, layout.linear().bits()) } else { NIL },
            format: layout.format(),
        };
        tally.want(row.bytes);
    }
}

/// What a resource is made with whose format an inlined epilogue replaced: few are.
#[cold]
#[inline(never)]
fn reformatted(layout: Layout, format: Format) -> Layout {
    layout.with_format(format)
}

/// Adds the slot that a resource is the first tenant of: size and levels counted out.
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

/// The slot of a shape that was freed last, which is free no more.
#[inline]
fn take_free<'t>(classes: &mut Classes, class: u32, tenancies: &'t mut [Tenancy]) -> Option<(u32, &'t mut Tenancy)> {
    let free = classes.free(class)?;
    let slot = *free;
    let tenancy = tenancies.get_mut(slot as usize)?;
    *free = tenancy.next_free;
    Some((slot, tenancy))
}

/// Notes that a slot is free.
#[inline]
fn give_back(classes: &mut Classes, class: u32, slot: u32, tenancies: &mut [Tenancy]) {
    if let Some(free) = classes.free(class) {
        tenancies[slot as usize].next_free = std::mem::replace(free, slot);
    }
}
