//! Memory blocks with the textures and buffers placed in them, kept between frames; and the driver's memory
//! requirements for the compiler.

use crate::device::gpu::Gpu;
use crate::execute::error::ExecuteError;
use crate::named::Named;
use crate::placed::driver::{Driver, Object};
use crate::placed::not_placed::NotPlaced;
use crate::placed::shape::{MemoryRequirements, Shape};
use crate::placed::submission::keeps_order_of_aliases;
use crate::resources::physical::PhysicalTextureDesc;
use crate::resources::pool::{Limits, PoolCounts, RECENT};
use crate::resources::requests::{PlacedRequest, Requests, shaped};
use crate::resources::support::{Unsupported, check_buffer, check_texture};
use framegraph::{Caps, Desc, Extent, Plan, TextureDesc};
use wgpu::{Buffer, Texture};

/// A block for textures and a block for buffers, with the resources placed in them.
#[derive(Debug)]
pub(crate) struct Arena {
    /// Description and offset of each object.
    key: Vec<(Shape, u64)>,
    pub(crate) objects: Vec<Object>,
    /// Allocated bytes, and bytes that the objects would need without sharing.
    allocated_bytes: [u64; 2],
    /// Number of the last frame that used the arena.
    used: u64,
}

/// All arenas of an executor. See the [module documentation](self).
#[derive(Debug, Default)]
pub(crate) struct Arenas {
    driver: Option<Result<Driver, NotPlaced>>,
    caps: Option<Caps>,
    requirements: Vec<(Shape, MemoryRequirements)>,
    requests: Requests,
    arenas: Vec<Arena>,
    frame: u64,
    /// Sizes of recent frames in bytes, as a ring buffer.
    recent: [u64; RECENT],
    /// Object counts are numbers of arenas, except `created`, which counts placed objects.
    counts: PoolCounts,
    skip_barriers: bool,
}

impl Arenas {
    /// Returns the capabilities for compiling with placed resources; those of the device if it does not support them.
    pub(crate) fn caps(&mut self, gpu: &Gpu) -> &Caps {
        let placed = self.driver(gpu).is_ok();
        self.caps.get_or_insert_with(|| match placed {
            true => Caps {
                placed: true,
                placed_histories: false,
                // Images and buffers may need different memory types.
                separate_heaps: true,
                texture_alignment_bytes: 1,
                buffer_alignment_bytes: 1,
                explicit_barriers: true,
                ..gpu.caps()
            },
            false => gpu.caps(),
        })
    }

    /// Returns why nothing is placed; `None` if placing works or was not requested.
    pub(crate) fn not_placed(&self) -> Option<&NotPlaced> {
        self.driver.as_ref().and_then(|driver| driver.as_ref().err())
    }

    /// Turns placing off from now on.
    pub(crate) fn disable(&mut self, gpu: &Gpu, why: NotPlaced) {
        (self.driver, self.caps) = (Some(Err(why)), Some(gpu.caps()));
    }

    fn driver(&mut self, gpu: &Gpu) -> Result<&Driver, NotPlaced> {
        self.driver.get_or_insert_with(|| Driver::of(gpu)).as_ref().map_err(Clone::clone)
    }

    /// Queries the memory requirements of the placed resources of `plan`. Returns true if they exceed the plan's
    /// assumptions; it must then be compiled again with [`Arenas::caps`]. Requirements are queried with and without
    /// poisoning, since both use the same plan.
    pub(crate) fn ask(&mut self, gpu: &Gpu, plan: &Plan) -> Result<bool, NotPlaced> {
        let mut more = false;
        for poison in [false, true] {
            let mut requests = std::mem::take(&mut self.requests);
            // Errors are reported when the plan is executed.
            let collected = requests.collect(plan, gpu, poison).is_ok();
            for request in requests.placed().iter().filter(|_| collected) {
                more |= self.learn(gpu, plan, request)?;
            }
            requests.clear();
            self.requests = requests;
        }
        Ok(more)
    }

    /// Queries the requirements of one resource. Returns true if the capabilities changed.
    fn learn(&mut self, gpu: &Gpu, plan: &Plan, request: &PlacedRequest) -> Result<bool, NotPlaced> {
        if check(gpu, &request.shape, "").is_err() {
            return Ok(false);
        }
        let MemoryRequirements { bytes, alignment, .. } = self.requirements_of(gpu, &request.shape)?;
        self.caps(gpu);
        let Some(caps) = &mut self.caps else { return Ok(false) };
        let aligned = match request.shape {
            Shape::Texture(_) => &mut caps.texture_alignment_bytes,
            // Rounding up to the alignment also accounts for the driver's padding of buffers.
            Shape::Buffer(_) => &mut caps.buffer_alignment_bytes,
        };
        let padding = bytes.saturating_sub(plan.resources()[request.resource.index()].bytes);
        let wanted = match request.shape {
            Shape::Texture(_) => alignment,
            Shape::Buffer(_) => alignment.max(padding.next_power_of_two()),
        };
        let mut more = wanted > *aligned;
        *aligned = wanted.max(*aligned);
        if let (Desc::Texture(desc), true) = (shaped(plan, request.resource), padding > 0) {
            let desc = absolute(desc, plan.frame());
            match caps.padded.iter_mut().find(|(known, _)| *known == desc) {
                Some((_, known)) => {
                    more |= bytes > *known;
                    *known = bytes.max(*known);
                }
                None => {
                    more = true;
                    caps.padded.push((desc, bytes));
                }
            }
        }
        Ok(more)
    }

    /// Returns the driver's memory requirements for a description, cached after the first query.
    fn requirements_of(&mut self, gpu: &Gpu, shape: &Shape) -> Result<MemoryRequirements, NotPlaced> {
        if let Some((_, needs)) = self.requirements.iter().find(|(known, _)| known == shape) {
            return Ok(*needs);
        }
        let needs = self.driver(gpu)?.memory_requirements(shape)?;
        self.requirements.push((*shape, needs));
        Ok(needs)
    }

    /// Begins a frame without a current arena.
    pub(crate) fn begin_frame(&mut self) {
        self.frame += 1;
    }

    /// Finds or creates the arena for `requests` and makes it [`Arenas::current`].
    ///
    /// # Errors
    /// Fails if the device cannot place resources, or the plan's offsets do not satisfy the driver's requirements.
    pub(crate) fn acquire(&mut self, gpu: &Gpu, plan: &Plan, requests: &[PlacedRequest]) -> Result<(), ExecuteError> {
        if requests.is_empty() {
            return Ok(());
        }
        let same = |arena: &Arena| arena.key.iter().copied().eq(requests.iter().map(|r| (r.shape, r.offset)));
        if let Some(at) = self.arenas.iter().position(same) {
            self.arenas[at].used = self.frame;
            self.arenas.swap(0, at);
            self.counts.hits += 1;
            return Ok(());
        }
        let mut all = Vec::with_capacity(requests.len());
        for request in requests {
            check(gpu, &request.shape, plan.graph().resource_name(request.resource))?;
            let needs = self.requirements_of(gpu, &request.shape)?;
            let (row, caps) = (&plan.resources()[request.resource.index()], plan.caps());
            let alignment = match request.shape {
                Shape::Texture(_) => caps.texture_alignment_bytes,
                Shape::Buffer(_) => caps.buffer_alignment_bytes,
            };
            let taken = row.bytes.checked_next_multiple_of(alignment.max(1)).unwrap_or(u64::MAX);
            if needs.bytes > taken || request.offset % needs.alignment != 0 {
                return Err(ExecuteError::Heap { resource: Named::resource(plan, request.resource) });
            }
            all.push(needs);
        }
        let name = |r: &PlacedRequest| plan.graph().resource_name(r.resource);
        let items: Vec<_> = requests.iter().map(|r| (r.shape, r.offset, name(r))).collect();
        let (objects, together) = self.driver(gpu)?.place(&items, &all)?;
        let allocated_bytes = [together, all.iter().map(|needs| needs.bytes).sum()];
        let key = requests.iter().map(|r| (r.shape, r.offset)).collect();
        self.counts.created += objects.len() as u64;
        self.arenas.push(Arena { key, objects, allocated_bytes, used: self.frame });
        let last = self.arenas.len() - 1;
        self.arenas.swap(0, last);
        Ok(())
    }

    /// Returns the arena of this frame; `None` if nothing is placed.
    pub(crate) fn current(&self) -> Option<&Arena> {
        self.arenas.first().filter(|arena| arena.used == self.frame)
    }

    /// Returns whether each command buffer of this frame must be submitted separately.
    pub(crate) fn submits_separately(&self, gpu: &Gpu) -> bool {
        self.current().is_some() && !keeps_order_of_aliases(gpu.info())
    }

    /// Returns the driver, if placing works.
    pub(crate) fn placing(&self) -> Option<&Driver> {
        self.driver.as_ref().and_then(|driver| driver.as_ref().ok())
    }

    /// Ends a frame. Keeps the arenas of the last two frames, and at most one older arena if it is within `limits`.
    /// Calls `gone` for each object that is dropped.
    pub(crate) fn evict(&mut self, limits: Limits, gone: impl FnMut(&Object)) {
        let (frame, held) = (self.frame, self.bytes());
        let used_bytes = self.current().map_or(0, Arena::bytes);
        self.recent[frame as usize % RECENT] = used_bytes;
        let largest = self.recent.iter().copied().max().unwrap_or(0);
        let budget_bytes = largest.saturating_mul(limits.budget.into());
        let newest_old = self.arenas.iter().map(|a| a.used).filter(|used| used + 1 < frame).max();
        let others = self.arenas.iter().filter(|a| a.used + 1 < frame && Some(a.used) != newest_old);
        let spare = held - others.map(Arena::bytes).sum::<u64>() <= budget_bytes;
        let kept = newest_old.filter(|used| spare && frame - used <= limits.max_age);
        self.retain(|arena| arena.used + 1 >= frame || Some(arena.used) == kept, gone);
        let peak_bytes = self.counts.peak_bytes.max(self.bytes());
        self.counts = PoolCounts { used_bytes, peak_bytes, budget_bytes, ..self.counts };
    }

    /// Drops all arenas except that of this frame, and calls `gone` for each object.
    pub(crate) fn trim(&mut self, gone: impl FnMut(&Object)) {
        let frame = self.frame;
        self.retain(|arena| arena.used == frame, gone);
    }

    fn retain(&mut self, stays: impl Fn(&Arena) -> bool, mut gone: impl FnMut(&Object)) {
        let before = self.arenas.len();
        self.arenas.retain(|arena| {
            let stays = stays(arena);
            if !stays {
                arena.objects.iter().for_each(&mut gone);
            }
            stays
        });
        self.counts.evicted += (before - self.arenas.len()) as u64;
    }

    /// Returns hits, creations and evictions since the beginning, and the current size.
    pub(crate) fn counts(&self) -> PoolCounts {
        PoolCounts { objects: self.arenas.len() as u64, bytes: self.bytes(), ..self.counts }
    }

    /// Drops the arena of this frame. Called after a device error, since it may be invalid.
    pub(crate) fn discard_frame(&mut self) {
        let frame = self.frame;
        self.arenas.retain(|arena| arena.used != frame);
    }

    /// Returns the allocated bytes of all arenas, and the bytes that their objects would need without sharing.
    pub(crate) fn allocated_bytes(&self) -> [u64; 2] {
        [0, 1].map(|which| self.arenas.iter().map(|arena| arena.allocated_bytes[which]).sum())
    }

    /// Returns the allocated bytes of all arenas.
    pub(crate) fn bytes(&self) -> u64 {
        self.arenas.iter().map(Arena::bytes).sum()
    }

    /// Returns whether aliasing barriers are omitted, for tests.
    pub(crate) fn skips_alias_barriers(&self) -> bool {
        self.skip_barriers
    }

    /// Omits aliasing barriers from now on.
    #[cfg(any(test, feature = "testing"))]
    pub(crate) fn skip_alias_barriers(&mut self) {
        self.skip_barriers = true;
    }
}

impl Arena {
    /// Returns the allocated bytes.
    fn bytes(&self) -> u64 {
        self.allocated_bytes[0]
    }

    /// Returns the texture with this index.
    pub(crate) fn texture(&self, at: usize) -> Option<(&Texture, PhysicalTextureDesc)> {
        match (&self.objects[at], self.key[at].0) {
            (Object::Texture(placed), Shape::Texture(shape)) => Some((placed.texture(), shape)),
            _ => None,
        }
    }

    /// Returns the buffer with this index.
    pub(crate) fn buffer(&self, at: usize) -> Option<&Buffer> {
        match &self.objects[at] {
            Object::Buffer(buffer) => Some(buffer),
            Object::Texture(_) => None,
        }
    }
}

/// Checks that the device supports the resource.
fn check(gpu: &Gpu, shape: &Shape, name: &str) -> Result<(), Unsupported> {
    match shape {
        Shape::Texture(shape) => check_texture(gpu, shape, name),
        Shape::Buffer(shape) => check_buffer(gpu, shape.bytes, name),
    }
}

/// Returns the description with its extent in texels, as used in the capabilities.
fn absolute(desc: TextureDesc, frame: [u32; 2]) -> TextureDesc {
    let [width, height] = desc.extent.texels(frame);
    TextureDesc { extent: Extent::Absolute { width, height }, ..desc }
}
