//! Current layouts of images, and barriers in terms of Vulkan.

use crate::convert::{accesses, layout, plane, stages};
use crate::driver::{BufferBarrier, Dependencies, ImageBarrier, Scope, Thing};
use crate::shape::Part;
use ash::vk;
use framegraph::{Barrier, Dimension, Format, Plan, ResourceId, State, TextureDesc};
use std::collections::BTreeMap;

/// Layout of each subresource of each image, as recorded so far.
pub(crate) struct Layouts {
    rows: BTreeMap<(Thing, u32), vk::ImageLayout>,
    /// See [`ExecutorOptions::explicit_chains`](crate::ExecutorOptions::explicit_chains).
    explicit_chains: bool,
}

impl Layouts {
    pub(crate) fn new(explicit_chains: bool) -> Self {
        Self { rows: BTreeMap::new(), explicit_chains }
    }

    /// Returns the layout of a part.
    pub(crate) fn get(&self, thing: Thing, part: u32) -> vk::ImageLayout {
        self.rows.get(&(thing, part)).copied().unwrap_or(vk::ImageLayout::UNDEFINED)
    }

    pub(crate) fn set(&mut self, thing: Thing, part: u32, layout: vk::ImageLayout) {
        self.rows.insert((thing, part), layout);
    }

    /// Forgets everything, since the images are destroyed.
    pub(crate) fn clear(&mut self) {
        self.rows.clear();
    }

    /// Keeps the layouts of these images only.
    pub(crate) fn retain(&mut self, kept: &[Thing]) {
        self.rows.retain(|(thing, _), _| kept.contains(thing));
    }

    /// Appends a barrier of the plan. With `behind`, the wait before it covers its source.
    pub(crate) fn barrier(
        &mut self,
        plan: &Plan,
        row: &Barrier,
        thing: Thing,
        behind: bool,
        pending: &mut Dependencies,
    ) {
        let to = stages(row.to_stages);
        let [reads, writes] = accesses(row.to_stages, row.to);
        let from_state = if row.aliases.is_none() { row.from } else { State::Undefined };
        let from = stages(row.from_stages);
        let mut scope = Scope { from, to, to_access: reads | writes, ..Scope::default() };
        if behind || from.is_empty() {
            // A semaphore, an aliasing barrier, or the barrier at the start of the frame waits at all stages. The same
            // stages as source order this barrier after it.
            scope.from = to;
        } else {
            scope.from_access = accesses(row.from_stages, from_state)[1];
            if plan.graph().has_alias(row.resource) {
                // The last write may be one of another import, in another state.
                scope.from_access |= vk::AccessFlags2::MEMORY_WRITE;
            }
        }
        if self.explicit_chains {
            pending.memory.push(Scope { from: scope.from, to: scope.to, ..Scope::default() });
        }
        if !row.aliases.is_none() && !behind {
            // Writes of other resources in this memory.
            pending.memory.push(scope);
        }
        match thing {
            Thing::Buffer(buffer) => pending.buffers.push(BufferBarrier { scope, buffer }),
            Thing::Image(_) => {
                let parts = row.first_part..row.first_part + row.parts;
                let old = |layouts: &Self, number: u32, format: Format, part: u32| match row.from {
                    State::Entry => layouts.get(thing, part),
                    state => layout(state, format, number),
                };
                self.transition(plan, row.resource, thing, parts, scope, pending, old, |format, number| {
                    layout(row.to, format, number)
                });
            }
        }
    }

    /// Appends transitions of some parts of an image. Neighboring levels share a barrier.
    pub(crate) fn transition(
        &mut self,
        plan: &Plan,
        id: ResourceId,
        thing: Thing,
        parts: std::ops::Range<u32>,
        scope: Scope,
        pending: &mut Dependencies,
        old: impl Fn(&Self, u32, Format, u32) -> vk::ImageLayout,
        new: impl Fn(Format, u32) -> vk::ImageLayout,
    ) {
        let (Thing::Image(image), Some(desc)) = (thing, plan.graph().resources()[id.index()].desc.texture()) else {
            return;
        };
        let format = plan.format(id).unwrap_or(desc.format);
        let first = pending.images.len();
        for index in parts {
            let part = Part::at(desc, plan.frame(), index);
            let layouts = [old(self, part.plane, format, index), new(format, part.plane)];
            self.set(thing, index, layouts[1]);
            let range = vk::ImageSubresourceRange {
                aspect_mask: plane(format, part.plane),
                base_mip_level: part.mip,
                level_count: 1,
                base_array_layer: part.layer,
                layer_count: 1,
            };
            match pending.images[first..].last_mut() {
                Some(last) if last.layouts == layouts && follows(&last.range, &range) => last.range.level_count += 1,
                _ => pending.images.push(ImageBarrier { scope, image, range, layouts }),
            }
        }
    }
}

/// Returns `true` if `next` is the level behind `last` in the same layer and plane.
fn follows(last: &vk::ImageSubresourceRange, next: &vk::ImageSubresourceRange) -> bool {
    last.aspect_mask == next.aspect_mask
        && last.base_array_layer == next.base_array_layer
        && last.base_mip_level + last.level_count == next.base_mip_level
}

/// Returns the number of parts of an image.
pub(crate) fn parts(desc: &TextureDesc, frame: [u32; 2], format: Format) -> u32 {
    debug_assert!(desc.dimension == Dimension::D2 || desc.tracked_layers() == 1);
    desc.mip_count(frame) * desc.tracked_layers() * format.planes()
}
