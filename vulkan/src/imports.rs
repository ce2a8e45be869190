//! Images and buffers of the engine, bound to the imports of a frame.

#![allow(unsafe_code, reason = "the engine promises that its handles are valid")]

use crate::driver::Thing;
use ash::vk;
use framegraph::{Entry, Kind, Plan, ResourceId};
use std::collections::BTreeMap;

/// A bound image or buffer.
#[derive(Clone, Copy)]
pub(crate) struct Import {
    pub(crate) thing: Thing,
    /// Layout before the frame.
    pub(crate) layout: vk::ImageLayout,
    /// Layout in which the frame leaves the image; `None` for the layout of its last use.
    pub(crate) leave: Option<vk::ImageLayout>,
}

/// Images and buffers of the engine by import, for one frame. [`Executor::execute`](crate::Executor::execute) takes the
/// list, because layouts and binary semaphores are promised once.
#[derive(Default)]
pub struct Imports {
    pub(crate) rows: BTreeMap<ResourceId, Import>,
    /// Semaphores that the frame waits for and signals.
    pub(crate) waits: Vec<vk::Semaphore>,
    pub(crate) signals: Vec<vk::Semaphore>,
}

impl Imports {
    /// Creates an empty list.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Binds an image to an import. `layout` is its layout before the frame; for an import with a declared state
    /// ([`Entry::Left`]), the state decides instead.
    ///
    /// # Safety
    /// - The image belongs to the device, and stays alive until the GPU has finished the frame.
    /// - Its extent, format, levels, layers and samples are those of the import, and its usage includes that of the
    ///   plan ([`Plan::resources`]), and `TRANSFER_DST` if a pass clears it through storage. It is an exclusive image of the first queue's family, or concurrent.
    /// - It is in `layout`, and earlier work on it was submitted to the first queue or waited for.
    pub unsafe fn image(&mut self, import: ResourceId, image: vk::Image, layout: vk::ImageLayout) {
        self.rows.insert(import, Import { thing: Thing::Image(image), layout, leave: None });
    }

    /// Binds a buffer to an import.
    ///
    /// # Safety
    /// - The buffer belongs to the device, and stays alive until the GPU has finished the frame.
    /// - Its size and usage include those of the plan. It is an exclusive buffer of the first queue's family, or
    ///   concurrent.
    /// - Earlier work on it was submitted to the first queue or waited for.
    pub unsafe fn buffer(&mut self, import: ResourceId, buffer: vk::Buffer) {
        let layout = vk::ImageLayout::UNDEFINED;
        self.rows.insert(import, Import { thing: Thing::Buffer(buffer), layout, leave: None });
    }

    /// Leaves a bound image in this layout after the frame, for example for presenting. Does nothing if the import is
    /// not bound.
    ///
    /// # Safety
    /// The usage of the image and the extensions of the device allow the layout, which is neither `UNDEFINED` nor
    /// `PREINITIALIZED`.
    pub unsafe fn leave_in(&mut self, import: ResourceId, layout: vk::ImageLayout) {
        if let Some(row) = self.rows.get_mut(&import) {
            row.leave = Some(layout);
        }
    }

    /// Returns the image bound to an import; `None` for a buffer or an import that is not bound.
    #[must_use]
    pub fn bound_image(&self, import: ResourceId) -> Option<vk::Image> {
        match self.rows.get(&import)?.thing {
            Thing::Image(image) => Some(image),
            Thing::Buffer(_) => None,
        }
    }

    /// Returns the buffer bound to an import; `None` for an image or an import that is not bound.
    #[must_use]
    pub fn bound_buffer(&self, import: ResourceId) -> Option<vk::Buffer> {
        match self.rows.get(&import)?.thing {
            Thing::Buffer(buffer) => Some(buffer),
            Thing::Image(_) => None,
        }
    }

    /// Waits for a binary semaphore before the frame, for example that of a swapchain image.
    ///
    /// # Safety
    /// The semaphore belongs to the device, stays alive until the GPU has finished the frame, and a submitted operation
    /// signals it.
    pub unsafe fn wait_for(&mut self, semaphore: vk::Semaphore) {
        self.waits.push(semaphore);
    }

    /// Signals a binary semaphore after the frame, for example for presenting.
    ///
    /// # Safety
    /// The semaphore belongs to the device, stays alive until the GPU has finished the frame, and is not signaled.
    pub unsafe fn signal(&mut self, semaphore: vk::Semaphore) {
        self.signals.push(semaphore);
    }

    /// Returns two imports that are bound to one image or buffer, unless the graph declares that they may alias, or
    /// passes only read them.
    ///
    /// Read-only images must also stay in one state, on one queue. Barriers track the layout of each import, but the
    /// image has only one.
    pub(crate) fn shared(&self, plan: &Plan, queues: usize) -> Option<[ResourceId; 2]> {
        let graph = plan.graph();
        let pairs = self.rows.iter().flat_map(|(a, row)| {
            let same = move |(b, other): &(&ResourceId, &Import)| *b > a && other.thing == row.thing;
            self.rows.iter().filter(same).map(|(b, _)| [*a, *b])
        });
        let written = |resource: ResourceId| {
            let kept = graph.pass_ids().filter(|pass| !plan.is_culled(*pass));
            kept.flat_map(|pass| graph.accesses_of(pass)).any(|a| a.resource == resource && a.mode.writes())
        };
        let mut pairs = pairs.filter(|[a, b]| !graph.are_aliases(*a, *b));
        pairs.find(|pair| {
            let is_image = matches!(self.rows[&pair[0]].thing, Thing::Image(_));
            pair.iter().any(|id| written(*id)) || is_image && (queues > 1 || !has_one_state(plan, *pair))
        })
    }

    /// Returns the first import that the plan uses and that is not bound, or bound to the wrong kind.
    pub(crate) fn missing(&self, plan: &Plan) -> Option<ResourceId> {
        let graph = plan.graph();
        graph.resource_ids().find(|id| {
            let row = &plan.resources()[id.index()];
            let used = row.placement == framegraph::Placement::External && !row.first.is_none();
            let is_image = graph.resources()[id.index()].desc.texture().is_some();
            let fits = |import: &Import| matches!(import.thing, Thing::Image(_)) == is_image;
            used && !self.rows.get(id).is_some_and(fits)
        })
    }
}

/// Returns `true` if every barrier of two imports leads to one state, which is also their declared state.
fn has_one_state(plan: &Plan, pair: [ResourceId; 2]) -> bool {
    let rows = plan.graph().resources();
    let declared = pair.iter().filter_map(|id| match rows[id.index()].kind {
        Kind::Imported { entry: Entry::Left { state, .. }, .. } => Some(state),
        _ => None,
    });
    let barriers = plan.barriers().iter().filter(|barrier| pair.contains(&barrier.resource));
    let mut states = declared.chain(barriers.map(|barrier| barrier.to));
    let first = states.next();
    states.all(|state| Some(state) == first)
}
