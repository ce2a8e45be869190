//! Phase 8 on back ends without placed resources: resources of one shape take turns in physical textures.
//!
//! A shape is what a texture is created with, the sRGB transfer function aside (two formats that differ only in it share
//! memory through view formats); uses are united. Within one shape, lifetimes are intervals, and giving each resource the
//! slot that was freed last, in the order of first use, needs as many slots as are ever live at once: no assignment needs
//! fewer. So the pool is optimal for its kind, and proved so.

use crate::access::Usage;
use crate::decision::{Decision, Reason, Subject};
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
    /// Next free slot of the same shape, by slot.
    next_free: Vec<u32>,
    /// The resource that had the slot last, and the shape, by slot.
    tenants: Vec<(ResourceId, u32)>,
    /// Resources by first and by last step: heads by step, links by resource.
    starts: Buckets,
    ends: Buckets,
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

/// Lists of resources by step, in the order of their ids, without a list object each.
#[derive(Debug, Default)]
struct Buckets {
    heads: Vec<u32>,
    links: Vec<u32>,
}

impl Buckets {
    fn fill(
        &mut self,
        steps: usize,
        resources: &[Planned],
        step_of: impl Fn(&Planned) -> Option<usize>,
    ) {
        self.heads.clear();
        self.heads.resize(steps, NIL);
        self.links.clear();
        self.links.resize(resources.len(), NIL);
        for (index, row) in resources.iter().enumerate().rev() {
            if let Some(step) = step_of(row) {
                self.links[index] = self.heads[step];
                self.heads[step] = index as u32;
            }
        }
    }

    fn of(&self, step: usize) -> impl Iterator<Item = usize> {
        let mut at = self.heads[step];
        std::iter::from_fn(move || {
            (at != NIL).then(|| {
                let index = at as usize;
                at = self.links[index];
                index
            })
        })
    }
}

/// Whether a resource takes part in sharing: touched, not placed yet (memoryless, own, external), and wanted.
fn takes_part(row: &Planned) -> bool {
    row.placement == Placement::Unused && !row.first.is_none()
}

/// Gives every resource that is still unplaced a slot; `share` off gives each its own.
pub(crate) fn pool(
    graph: &Graph,
    frame: [u32; 2],
    steps: usize,
    share: bool,
    scratch: &mut PoolScratch,
    resources: &mut [Planned],
    slots: &mut Vec<Slot>,
    decisions: &mut Vec<Decision>,
) {
    slots.clear();
    let PoolScratch {
        table,
        generation,
        free,
        next_free,
        tenants,
        starts,
        ends,
    } = scratch;
    starts.fill(steps, resources, |r| takes_part(r).then(|| r.first.index()));
    ends.fill(steps, resources, |r| takes_part(r).then(|| r.last.index()));
    free.clear();
    next_free.clear();
    tenants.clear();
    *generation = generation.wrapping_add(1);
    if *generation == 0 || table.len() < resources.len() * 2 {
        table.clear();
        table.resize(
            (resources.len() * 2).next_power_of_two().max(16),
            Entry::default(),
        );
        *generation = 1;
    }
    for step in 0..steps {
        for index in starts.of(step) {
            let resource = ResourceId::at(index);
            let desc = resolved(graph, resource, resources[index].format, frame);
            let class = if share {
                class_of(table, *generation, free, key_of(&desc))
            } else {
                free.len() as u32
            };
            let taken = if share { free[class as usize] } else { NIL };
            let reason = match taken {
                NIL => {
                    let id = slots.len();
                    slots.push(Slot {
                        desc,
                        usage: Usage::NONE,
                        srgb_twins: false,
                        bytes: resources[index].bytes,
                    });
                    next_free.push(NIL);
                    tenants.push((resource, class));
                    resources[index].placement = Placement::Slot(SlotId::at(id));
                    if share {
                        Reason::SlotFirst
                    } else {
                        Reason::AliasingOff
                    }
                }
                id => {
                    let slot = id as usize;
                    free[class as usize] = next_free[slot];
                    let before = std::mem::replace(&mut tenants[slot].0, resource);
                    resources[index].placement = Placement::Slot(SlotId::at(slot));
                    Reason::SlotAfter(before)
                }
            };
            let Placement::Slot(id) = resources[index].placement else {
                continue;
            };
            let slot = &mut slots[id.index()];
            slot.usage = slot.usage.union(resources[index].usage);
            slot.srgb_twins |= format_of(&slot.desc) != format_of(&desc);
            decisions.push(Decision {
                subject: Subject::Resource(resource),
                reason,
            });
        }
        for index in ends.of(step) {
            let Placement::Slot(id) = resources[index].placement else {
                continue;
            };
            if share {
                let class = tenants[id.index()].1 as usize;
                next_free[id.index()] = free[class];
                free[class] = id.index() as u32;
            }
        }
    }
}

fn format_of(desc: &Desc) -> Option<crate::format::Format> {
    desc.texture().map(|t| t.format)
}

/// The shape with which a resource is created: size and levels counted out.
pub(crate) fn resolved(
    graph: &Graph,
    resource: ResourceId,
    format: Option<crate::format::Format>,
    frame: [u32; 2],
) -> Desc {
    match graph.resources[resource.index()].desc {
        Desc::Texture(t) => {
            let [width, height] = t.extent.resolve(frame);
            let mips = t.mip_count(frame) as u8;
            Desc::Texture(TextureDesc {
                extent: Extent::Absolute { width, height },
                mips,
                format: format.unwrap_or(t.format),
                ..t
            })
        }
        buffer @ Desc::Buffer(_) => buffer,
    }
}

fn key_of(desc: &Desc) -> Key {
    match desc {
        Desc::Buffer(b) => Key {
            low: b.bytes,
            high: 1 << 63,
        },
        Desc::Texture(t) => {
            let [width, height] = t.extent.resolve([0; 2]);
            let dimension = u64::from(t.dimension == Dimension::D3);
            let high = t.format.linear_twin() as u64
                | u64::from(t.mips) << 8
                | u64::from(t.samples) << 16
                | u64::from(t.layers) << 24
                | dimension << 40;
            Key {
                low: u64::from(width) | u64::from(height) << 32,
                high,
            }
        }
    }
}

/// The number of a shape, from 0 without gaps.
fn class_of(table: &mut [Entry], generation: u32, free: &mut Vec<u32>, key: Key) -> u32 {
    let hash = (key.low ^ key.high.rotate_left(29)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    let mask = table.len() - 1;
    let mut at = (hash >> 32) as usize & mask;
    loop {
        let entry = &mut table[at];
        if entry.generation != generation {
            *entry = Entry {
                key,
                class: free.len() as u32,
                generation,
            };
            free.push(NIL);
            return entry.class;
        }
        if entry.key == key {
            return entry.class;
        }
        at = (at + 1) & mask;
    }
}
