//! Phase 8 on back ends without placed resources: resources of one shape take turns in physical textures.
//!
//! A shape is what a texture is created with, the sRGB transfer function aside (two formats that differ only in it share
//! memory through view formats); uses are united. Within one shape, lifetimes are intervals, and giving each resource the
//! slot that was freed last, in the order of first use, needs as many slots as are ever live at once: no assignment needs
//! fewer. So the pool is optimal for its kind, and proved so.

use super::measure::Measured;
use crate::decision::{Decision, Reason, Subject};
use crate::format::Format;
use crate::graph::Graph;
use crate::id::{ResourceId, SlotId};
use crate::plan::{Placement, Planned, Slot};
use crate::resource::{Desc, Dimension, Extent, TextureDesc};

const NIL: u32 = u32::MAX;

/// Memory of the phase, kept between compiles.
#[derive(Debug, Default)]
pub(crate) struct PoolScratch {
    /// Open-addressing table of shapes.
    table: Vec<Entry>,
    generation: u32,
    /// First free slot of each shape.
    free: Vec<u32>,
    /// By slot.
    tenancies: Vec<Tenancy>,
    lists: Lists,
}

/// How a slot is used.
#[derive(Clone, Copy, Debug)]
struct Tenancy {
    /// The resource that had it last.
    last: ResourceId,
    /// Its shape.
    class: u32,
    /// The next free slot of that shape, while it is free.
    next_free: u32,
}

#[derive(Clone, Copy, Debug, Default)]
struct Entry {
    key: Key,
    class: u32,
    generation: u32,
}

/// What two resources must have in common to share a slot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Key {
    low: u64,
    high: u64,
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

impl Lists {
    fn fill(&mut self, steps: usize, resources: &[Planned]) {
        let Self { heads, links } = self;
        heads.clear();
        heads.resize(steps, NO_LINKS);
        links.clear();
        links.resize(resources.len(), NO_LINKS);
        for (index, (row, link)) in resources.iter().zip(links).enumerate().rev() {
            if takes_part(row) {
                let start = &mut heads[row.first.index()].start;
                link.start = std::mem::replace(start, index as u32);
                let end = &mut heads[row.last.index()].end;
                link.end = std::mem::replace(end, index as u32);
            }
        }
    }
}

/// Whether a resource takes part in sharing: touched, not placed yet (memoryless, own, external), and wanted.
fn takes_part(row: &Planned) -> bool {
    row.placement == Placement::Unused && !row.first.is_none()
}

/// Gives every resource that is still unplaced a slot; `share` off gives each its own.
pub(crate) fn pool(
    graph: &Graph,
    measures: &[Measured],
    steps: usize,
    share: bool,
    scratch: &mut PoolScratch,
    resources: &mut [Planned],
    slots: &mut Vec<Slot>,
    decisions: &mut Vec<Decision>,
) {
    slots.clear();
    let PoolScratch { table, generation, free, tenancies, lists } = scratch;
    lists.fill(steps, resources);
    let Lists { heads, links } = lists;
    free.clear();
    tenancies.clear();
    *generation = generation.wrapping_add(1);
    if *generation == 0 || table.len() < resources.len() * 2 {
        table.clear();
        table.resize((resources.len() * 2).next_power_of_two().max(16), Entry::default());
        *generation = 1;
    }
    // Rows of one resource: one check of its number serves for all four.
    let count = resources.len();
    let (declared, measures, links) = (&graph.resources[..count], &measures[..count], &mut links[..count]);
    for heads in heads.iter() {
        let mut at = heads.start;
        while at != NIL {
            let (index, resource) = (at as usize, ResourceId::at(at as usize));
            let row = &mut resources[index];
            let declared = &declared[index].desc;
            let format = row.format.or(format_of(declared));
            let (class, taken) = if share {
                let key = key_of(declared, format, &measures[index]);
                let class = class_of(table, *generation, free, key);
                (class, free[class as usize])
            } else {
                (NIL, NIL)
            };
            let (slot, reason) = if taken == NIL {
                slots.push(Slot {
                    desc: resolved(declared, format, &measures[index]),
                    usage: row.usage,
                    srgb_twins: false,
                    bytes: row.bytes,
                });
                tenancies.push(Tenancy { last: resource, class, next_free: NIL });
                let reason = if share { Reason::SlotFirst } else { Reason::AliasingOff };
                (slots.len() as u32 - 1, reason)
            } else {
                let (tenancy, slot) = (&mut tenancies[taken as usize], &mut slots[taken as usize]);
                free[class as usize] = tenancy.next_free;
                slot.usage = slot.usage.union(row.usage);
                slot.srgb_twins |= format_of(&slot.desc) != format;
                let before = std::mem::replace(&mut tenancy.last, resource);
                (taken, Reason::SlotAfter(before))
            };
            row.placement = Placement::Slot(SlotId::at(slot as usize));
            at = std::mem::replace(&mut links[index].start, slot);
            let subject = Subject::Resource(resource);
            decisions.push(Decision { subject, reason });
        }
        let mut at = if share { heads.end } else { NIL };
        while at != NIL {
            let Links { start: slot, end } = links[at as usize];
            let tenancy = &mut tenancies[slot as usize];
            tenancy.next_free = std::mem::replace(&mut free[tenancy.class as usize], slot);
            at = end;
        }
    }
}

fn format_of(desc: &Desc) -> Option<Format> {
    desc.texture().map(|t| t.format)
}

/// The shape with which a resource is created: size and levels counted out.
fn resolved(declared: &Desc, format: Option<Format>, measured: &Measured) -> Desc {
    match declared {
        Desc::Texture(t) => {
            let [width, height] = measured.extent;
            Desc::Texture(TextureDesc {
                extent: Extent::Absolute { width, height },
                mips: measured.mips as u8,
                format: format.unwrap_or(t.format),
                ..*t
            })
        }
        Desc::Buffer(_) => *declared,
    }
}

#[inline]
fn key_of(declared: &Desc, format: Option<Format>, measured: &Measured) -> Key {
    match declared {
        Desc::Buffer(b) => Key { low: b.bytes, high: 1 << 63 },
        Desc::Texture(t) => {
            let [width, height] = measured.extent;
            let dimension = u64::from(t.dimension == Dimension::D3);
            let high = format.unwrap_or(t.format).linear_twin() as u64
                | u64::from(measured.mips) << 8
                | u64::from(t.samples) << 16
                | u64::from(t.layers) << 24
                | dimension << 40;
            Key { low: u64::from(width) | u64::from(height) << 32, high }
        }
    }
}

/// The number of a shape, from 0 without gaps.
#[inline]
fn class_of(table: &mut [Entry], generation: u32, free: &mut Vec<u32>, key: Key) -> u32 {
    let hash = (key.low ^ key.high.rotate_left(29)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mask = table.len() - 1;
    let mut at = (hash >> 32) as usize & mask;
    loop {
        let entry = &mut table[at];
        if entry.generation != generation {
            *entry = Entry { key, class: free.len() as u32, generation };
            free.push(NIL);
            return entry.class;
        }
        if entry.key == key {
            return entry.class;
        }
        at = (at + 1) & mask;
    }
}
