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
use crate::graph::Tables;
use crate::id::{ResourceId, SlotId, StepId};
use crate::plan::{Memory, Placement, Planned, Slot};
use crate::resource::{Desc, Extent, Resource, TextureDesc};

const NIL: u32 = u32::MAX;

/// Memory of the phase, kept between compiles.
#[derive(Debug, Default)]
pub(crate) struct PoolScratch {
    classes: Classes,
    /// By slot.
    tenancies: Vec<Tenancy>,
    lists: Lists,
}

/// How a slot is used.
#[derive(Clone, Copy, Debug)]
struct Tenancy {
    /// The resource that had it last.
    last: ResourceId,
    /// Its shape; [`NIL`] when nothing is shared.
    class: u32,
    /// The next free slot of that shape, while it is free.
    next_free: u32,
    /// Every use by any tenant.
    usage: Usage,
    /// The format of its first tenant, and whether another's differs.
    format: u8,
    twins: bool,
}

/// Resources by first and by last step, in the order of their ids, without a list object each.
#[derive(Debug, Default)]
struct Lists {
    heads: Vec<Links>,
    links: Vec<Links>,
}

/// The next resource that starts, and that ends, at the same step.
#[derive(Clone, Copy, Debug)]
struct Links {
    /// Once the resource has started, its slot.
    start: u32,
    end: u32,
}

const NO_LINKS: Links = Links { start: NIL, end: NIL };

/// Whether a resource takes part in sharing: touched, not placed yet (memoryless, own, external), and wanted.
fn takes_part(row: &Planned) -> bool {
    row.placement == Placement::Unused && !row.first.is_none()
}

impl Lists {
    /// Fills the lists with what takes part, and counts the rest.
    fn fill(&mut self, steps: usize, declared: &[Resource], resources: &[Planned], tally: &mut Tally) {
        let Self { heads, links } = self;
        heads.clear();
        heads.resize(steps, NO_LINKS);
        links.resize(resources.len(), NO_LINKS);
        for (index, ((row, link), declared)) in resources.iter().zip(links).zip(declared).enumerate().rev() {
            if takes_part(row) {
                link.start = std::mem::replace(&mut heads[row.first.index()].start, index as u32);
                link.end = std::mem::replace(&mut heads[row.last.index()].end, index as u32);
            } else {
                tally.apart(declared.kind, row);
            }
        }
    }
}

/// Gives every resource that is still unplaced a slot, `share` off each its own, and sums up the memory.
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
    let PoolScratch { classes, tenancies, lists } = scratch;
    lists.fill(steps, &graph.resources, resources, &mut tally);
    let Lists { heads, links } = lists;
    tenancies.clear();
    classes.clear(resources.len());
    // Rows of one resource: one check of its number serves for all.
    let count = resources.len();
    let (measures, links) = (&measures[..count], &mut links[..count]);
    for (step, heads) in heads.iter().enumerate() {
        let mut at = heads.start;
        while at != NIL {
            let (index, resource) = (at as usize, ResourceId::at(at as usize));
            let (row, measured) = (&mut resources[index], &measures[index]);
            tally.begin(row.bytes);
            let layout = row.format.map_or(measured.layout, |format| measured.layout.with_format(format));
            let (class, taken) =
                if share { classes.take_free(size_of(measured), layout, tenancies) } else { (NIL, NIL) };
            let (slot, reason) = match tenancies.get_mut(taken as usize) {
                Some(tenancy) => {
                    tenancy.usage = tenancy.usage.union(row.usage);
                    tenancy.twins |= tenancy.format != layout.format();
                    (taken, Reason::SlotAfter(std::mem::replace(&mut tenancy.last, resource)))
                }
                None => {
                    tally.take(row.bytes);
                    slots.push(slot_for(&graph.resources[index].desc, row, measured));
                    let (usage, format) = (row.usage, layout.format());
                    tenancies.push(Tenancy { last: resource, class, next_free: NIL, usage, format, twins: false });
                    let reason = if share { Reason::SlotFirst } else { Reason::AliasingOff };
                    (slots.len() as u32 - 1, reason)
                }
            };
            row.placement = Placement::Slot(SlotId::at(slot as usize));
            at = std::mem::replace(&mut links[index].start, slot);
            decisions.push(Decision { subject: Subject::Resource(resource), reason });
        }
        tally.begun(StepId::at(step));
        let mut at = heads.end;
        while at != NIL {
            let Links { start: slot, end } = links[at as usize];
            tally.end(resources[at as usize].bytes);
            classes.give_back(slot, &mut tenancies[slot as usize]);
            at = end;
        }
    }
    for (slot, tenancy) in slots.iter_mut().zip(tenancies) {
        (slot.usage, slot.srgb_twins) = (tenancy.usage, tenancy.twins);
    }
    tally.finish()
}

/// The slot that a resource is the first tenant of: size and levels counted out.
#[inline(never)]
fn slot_for(declared: &Desc, row: &Planned, measured: &Measured) -> Slot {
    let desc = match declared {
        Desc::Texture(t) => {
            let [width, height] = measured.extent;
            Desc::Texture(TextureDesc {
                extent: Extent::Absolute { width, height },
                mips: measured.layout.mips(),
                format: row.format.unwrap_or(t.format),
                ..*t
            })
        }
        Desc::Buffer(_) => *declared,
    };
    Slot { desc, usage: row.usage, srgb_twins: false, bytes: row.bytes }
}

/// What two resources must have in common to share a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Key {
    /// Width and height in texels; the bytes of a buffer.
    size: u64,
    /// Without the sRGB transfer function.
    layout: Layout,
}

/// Two resources of one layout share a slot if these are equal: both sides of a texture, or the bytes of a buffer.
#[inline]
fn size_of(measured: &Measured) -> u64 {
    if measured.layout == Layout::BUFFER {
        return measured.bytes;
    }
    let [width, height] = measured.extent;
    u64::from(width) | u64::from(height) << 32
}

/// One shape, with its free slots.
#[derive(Clone, Copy, Debug)]
struct Class {
    key: Key,
    /// Its place in the table.
    home: u32,
    /// Its slot that was freed last.
    free: u32,
}

/// The shapes that were met, found by hashing.
#[derive(Debug, Default)]
struct Classes {
    /// Open addressing: numbers of classes, by hash. An entry counts only if that class names it as its home, so that the
    /// table is not cleared.
    table: Vec<u32>,
    classes: Vec<Class>,
}

impl Classes {
    /// Forgets all shapes; there will be `most` at most.
    fn clear(&mut self, most: usize) {
        self.classes.clear();
        if self.table.len() < most * 2 {
            self.table.resize((most * 2).next_power_of_two().max(16), 0);
        }
    }

    /// The class of a shape, and the slot of that class that was freed last, which is free no more; [`NIL`] for none.
    #[inline]
    fn take_free(&mut self, size: u64, layout: Layout, tenancies: &[Tenancy]) -> (u32, u32) {
        let key = Key { size, layout: layout.linear() };
        let class = self.class_of(key);
        let free = &mut self.classes[class as usize].free;
        let taken = *free;
        if let Some(tenancy) = tenancies.get(taken as usize) {
            *free = tenancy.next_free;
        }
        (class, taken)
    }

    /// Notes that the slot is free.
    #[inline]
    fn give_back(&mut self, slot: u32, tenancy: &mut Tenancy) {
        if let Some(class) = self.classes.get_mut(tenancy.class as usize) {
            tenancy.next_free = std::mem::replace(&mut class.free, slot);
        }
    }

    /// The number of a shape, from 0 without gaps.
    #[inline]
    fn class_of(&mut self, key: Key) -> u32 {
        let Self { table, classes } = self;
        let hash = (key.size ^ key.layout.bits().rotate_left(29)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        let mask = table.len() - 1;
        let mut at = (hash >> 32) as usize & mask;
        loop {
            let number = table[at];
            match classes.get(number as usize) {
                Some(class) if class.key == key => return number,
                Some(class) if class.home == at as u32 => at = (at + 1) & mask,
                _ => {
                    table[at] = classes.len() as u32;
                    classes.push(Class { key, home: at as u32, free: NIL });
                    return table[at];
                }
            }
        }
    }
}
