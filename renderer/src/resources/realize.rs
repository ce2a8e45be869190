//! Allocation of physical textures and buffers according to the plan.

use crate::device::gpu::Gpu;
use crate::execute::error::ExecuteError;
use crate::frame_key::FrameKey;
use crate::named::Named;
use crate::placed::arenas::{Arena, Arenas};
use crate::resources::history::{Declared, Earlier, Histories};
use crate::resources::imports::{ImportError, Imports, Lifetime};
use crate::resources::no_memory::NoMemory;
use crate::resources::physical::{PhysicalBufferDesc, PhysicalTextureDesc};
use crate::resources::pool::Pool;
use crate::resources::requests::{Requests, offered, shaped};
use framegraph::{Access, AccessKind, Desc, Kind, Placement, Plan, ResourceId, Usage};
use wgpu::{Buffer, Texture};

/// Physical resource of the current frame.
#[derive(Clone, Debug)]
pub(crate) enum Physical {
    /// No memory, with the reason.
    Absent(NoMemory),
    /// A texture. For histories, `missed` is the number of executions without a write, or `None` if the contents are
    /// not valid.
    Texture { texture: Texture, shape: PhysicalTextureDesc, missed: Option<u64>, lifetime: Lifetime },
    /// A buffer. The resource is its first `bytes` bytes.
    Buffer { buffer: Buffer, bytes: u64 },
}

/// Physical resources of a plan.
#[derive(Debug, Default)]
pub(crate) struct Realized {
    /// Physical resources, in the order of the graph's resources.
    resources: Vec<Physical>,
    /// Unique number for each resource, which changes when its texture changes; 0 for surface textures, which change in
    /// every frame.
    stamps: Vec<u64>,
    /// Last stamp that was assigned.
    last_stamp: u64,
    /// Resources that may change in every frame of the same plan: imports and histories.
    changing: Vec<ResourceId>,
    /// Number of memoryless textures.
    memoryless: u32,
    /// Compilation number of the plan; 0 if empty.
    compilation: u64,
    requests: Requests,
}

/// Pools, histories and imports to allocate from.
pub(crate) struct Sources<'a> {
    pub(crate) gpu: &'a Gpu,
    /// Frame that is executed.
    pub(crate) owner: &'a FrameKey,
    pub(crate) textures: &'a mut Pool<PhysicalTextureDesc>,
    pub(crate) buffers: &'a mut Pool<PhysicalBufferDesc>,
    pub(crate) histories: &'a mut Histories,
    pub(crate) imports: &'a Imports,
    pub(crate) arenas: &'a mut Arenas,
    /// True if undefined contents will be filled, which requires additional usages.
    pub(crate) poison: bool,
}

impl Realized {
    /// Removes all references to physical objects.
    pub(crate) fn clear(&mut self) {
        self.compilation = 0;
        self.resources.clear();
        self.stamps.clear();
        self.changing.clear();
        self.requests.clear();
    }

    /// Returns the physical resource of `resource`; absent if no frame was executed.
    pub(crate) fn get(&self, resource: ResourceId) -> &Physical {
        self.resources.get(resource.index()).unwrap_or(&Physical::Absent(NoMemory::NotRealized))
    }

    /// Returns a number that identifies the texture of `resource` and is never reused. `None` for textures that must
    /// not be cached beyond this frame.
    pub(crate) fn stamp(&self, resource: ResourceId) -> Option<u64> {
        self.stamps.get(resource.index()).copied().filter(|stamp| *stamp != 0)
    }

    /// Releases surface textures and calls `gone` for each.
    pub(crate) fn end_loans(&mut self, mut gone: impl FnMut(&Texture)) {
        for resource in &self.changing {
            let physical = &mut self.resources[resource.index()];
            if let Physical::Texture { texture, lifetime: Lifetime::Frame, .. } = physical {
                gone(texture);
                *physical = Physical::Absent(NoMemory::Lent);
            }
        }
    }

    /// Allocates everything in `plan`. If the plan is unchanged, only resources that may have changed are updated.
    ///
    /// # Errors
    /// Fails if an import is missing or does not match, or the device does not support a resource.
    pub(crate) fn realize(&mut self, plan: &Plan, from: &mut Sources<'_>) -> Result<(), ExecuteError> {
        from.textures.begin_frame();
        from.buffers.begin_frame();
        from.histories.begin_frame(from.owner);
        from.arenas.begin_frame();
        // Invalid until allocation succeeds.
        let before = std::mem::take(&mut self.compilation);
        let settled = from.textures.is_settled() && from.buffers.is_settled() && !self.shares_memory();
        if before != 0 && before == plan.compilation() && settled {
            from.textures.acquire_again();
            from.buffers.acquire_again();
        } else {
            self.realize_anew(plan, from)?;
        }
        // The list is restored after an error too, so that surface textures are released.
        let changing = std::mem::take(&mut self.changing);
        let updated = self.update(plan, &changing, from);
        self.changing = changing;
        updated?;
        self.compilation = plan.compilation();
        Ok(())
    }

    /// Updates the resources that may have changed.
    ///
    /// # Errors
    /// Fails like [`Realized::realize`].
    fn update(&mut self, plan: &Plan, changing: &[ResourceId], from: &mut Sources<'_>) -> Result<(), ExecuteError> {
        let earlier = |resource: &ResourceId| match plan.graph().resources()[resource.index()].kind {
            Kind::HistoryPrevious { current, age } => Some((current, age)),
            _ => None,
        };
        for resource in changing.iter().filter(|r| earlier(r).is_none()) {
            let physical = self.place(plan, *resource, from)?;
            self.set(*resource, physical);
        }
        // Previous images are looked up after their history is declared, which may come later in the list.
        for (resource, (current, age)) in changing.iter().filter_map(|r| Some((r, earlier(r)?))) {
            let physical = self.previous(plan, current, age, from.histories);
            self.set(*resource, physical);
        }
        Ok(self.check_shared(plan, changing)?)
    }

    /// Refuses a texture or buffer behind two imports if a pass writes one of them, unless the graph declares that they may alias.
    ///
    /// Imports that passes only read are allowed: a default texture may serve several of them.
    fn check_shared(&self, plan: &Plan, changing: &[ResourceId]) -> Result<(), ImportError> {
        let graph = plan.graph();
        let same = |a: ResourceId, b: ResourceId| match (&self.resources[a.index()], &self.resources[b.index()]) {
            (Physical::Texture { texture: a, .. }, Physical::Texture { texture: b, .. }) => a == b,
            (Physical::Buffer { buffer: a, .. }, Physical::Buffer { buffer: b, .. }) => a == b,
            _ => false,
        };
        let imported = |r: &&ResourceId| matches!(graph.resources()[r.index()].kind, Kind::Imported { .. });
        let written = |resource: ResourceId| {
            let kept = graph.pass_ids().filter(|pass| !plan.is_culled(*pass));
            kept.flat_map(|pass| graph.accesses_of(pass)).any(|a| a.resource == resource && a.mode.writes())
        };
        for (at, resource) in changing.iter().enumerate().filter(|(_, r)| imported(r)) {
            for other in changing[at + 1..].iter().filter(imported).filter(|r| same(*resource, **r)) {
                if !graph.are_aliases(*resource, *other) && (written(*resource) || written(*other)) {
                    let is_buffer = graph.resources()[resource.index()].desc.texture().is_none();
                    let [resource, other] = [*resource, *other].map(|r| Named::resource(plan, r));
                    return Err(ImportError::Shared { resource, other, is_buffer });
                }
            }
        }
        Ok(())
    }

    /// Allocates everything from pools and heaps, and collects the resources that must be updated in every frame.
    fn realize_anew(&mut self, plan: &Plan, from: &mut Sources<'_>) -> Result<(), ExecuteError> {
        self.clear();
        self.requests.collect(plan, from.gpu, from.poison)?;
        self.requests.serve(from.gpu, plan, from.textures, from.buffers)?;
        from.arenas.acquire(from.gpu, plan, self.requests.placed())?;
        let count = plan.resources().len();
        self.resources.resize(count, Physical::Absent(NoMemory::NotRealized));
        self.stamps.resize(count, 0);
        for resource in plan.graph().resource_ids() {
            let kind = plan.graph().resources()[resource.index()].kind;
            let is_history = matches!(kind, Kind::HistoryCurrent { .. } | Kind::HistoryPrevious { .. });
            if is_history || plan.resources()[resource.index()].placement == Placement::External {
                self.changing.push(resource);
            } else {
                let physical = self.place(plan, resource, from)?;
                self.set(resource, physical);
            }
        }
        let transient = |p: &&Physical| matches!(p, Physical::Texture { shape, .. } if shape.is_memoryless());
        self.memoryless = self.resources.iter().filter(transient).count() as u32;
        Ok(())
    }

    /// Sets the physical resource, with a new stamp if its texture changed.
    fn set(&mut self, resource: ResourceId, physical: Physical) {
        let (known, stamp) = (&mut self.resources[resource.index()], &mut self.stamps[resource.index()]);
        if let Physical::Texture { texture, shape, lifetime, .. } = &physical {
            let same = matches!(&*known, Physical::Texture { texture: t, shape: s, .. } if t == texture && s == shape);
            if *lifetime == Lifetime::Frame {
                *stamp = 0;
            } else if !same || *stamp == 0 {
                self.last_stamp += 1;
                *stamp = self.last_stamp;
            }
        }
        *known = physical;
    }

    /// Returns the index of a resource in its arena; `None` if it is not placed.
    pub(crate) fn placed_at(&self, resource: ResourceId) -> Option<usize> {
        self.requests.placed_at(resource)
    }

    /// Returns whether there are placed resources.
    pub(crate) fn shares_memory(&self) -> bool {
        !self.requests.placed().is_empty()
    }

    /// Returns the number of memoryless textures.
    pub(crate) fn memoryless(&self) -> u32 {
        self.memoryless
    }

    /// Returns the physical resource for one resource, after the pools have served their requests.
    fn place(&self, plan: &Plan, resource: ResourceId, from: &mut Sources<'_>) -> Result<Physical, ExecuteError> {
        let (row, declared) = (&plan.resources()[resource.index()], &plan.graph().resources()[resource.index()]);
        match row.placement {
            Placement::Slot(_) | Placement::Memoryless => {}
            Placement::Own => match declared.kind {
                Kind::HistoryCurrent { frames } => {
                    return self.current(plan, resource, frames, from);
                }
                Kind::Transient | Kind::Imported { .. } | Kind::HistoryPrevious { .. } => {}
            },
            Placement::External if !row.first.is_none() => {
                return external(plan, resource, from.imports);
            }
            Placement::Heap { .. } => {
                if let Some(at) = self.requests.placed_at(resource) {
                    return Ok(in_arena(plan, resource, from.arenas.current(), at));
                }
            }
            Placement::External | Placement::Unused => {
                return Ok(Physical::Absent(NoMemory::Unused));
            }
            Placement::Inlined => {
                return Ok(Physical::Absent(NoMemory::Inlined));
            }
        }
        Ok(match declared.desc {
            Desc::Texture(_) => {
                let (texture, shape) = self.requests.texture(resource);
                Physical::Texture { texture, shape, missed: Some(0), lifetime: Lifetime::Kept }
            }
            Desc::Buffer(b) => {
                Physical::Buffer { buffer: self.requests.buffer(resource), bytes: b.bytes(plan.frame()) }
            }
        })
    }

    fn current(
        &self,
        plan: &Plan,
        resource: ResourceId,
        frames: u8,
        from: &mut Sources<'_>,
    ) -> Result<Physical, ExecuteError> {
        let Desc::Texture(desc) = shaped(plan, resource) else {
            return Ok(Physical::Absent(NoMemory::IsBuffer));
        };
        let rows = plan.graph().resources().iter().zip(plan.resources());
        let is_earlier = |kind| matches!(kind, Kind::HistoryPrevious { current, .. } if current == resource);
        let (earlier, views_earlier) = rows
            .filter(|(r, _)| is_earlier(r.kind))
            .fold((Usage::NONE, false), |(usage, views), (_, row)| (usage.union(row.usage), views || row.srgb_views));
        let own = plan.resources()[resource.index()];
        let usage = own.usage.union(self.requests.extra(resource)).union(earlier);
        let views = own.srgb_views || views_earlier;
        if usage.is_empty() {
            return Ok(Physical::Absent(NoMemory::Unused));
        }
        let mut shape = PhysicalTextureDesc::new(&desc, plan.frame(), usage, views);
        // An inspection may read the history regardless of the frame's own usages.
        shape.usage |= offered(from.gpu, desc.format);
        let reads =
            plan.graph().accesses().iter().filter(|a| is_earlier(plan.graph().resources()[a.resource.index()].kind));
        let now = Declared {
            shape,
            frames,
            written: !plan.resources()[resource.index()].first.is_none(),
            attached: earlier.contains(Usage::ATTACHMENT),
            levels: reads.map(|read| levels_for(read, shape.mips)).max().unwrap_or(1),
        };
        let texture = from.histories.current(from.gpu, plan.graph().resource_name(resource), now)?;
        Ok(Physical::Texture { texture, shape, missed: Some(0), lifetime: Lifetime::Kept })
    }

    fn previous(&self, plan: &Plan, current: ResourceId, age: u8, histories: &Histories) -> Physical {
        match histories.previous(plan.graph().resource_name(current), age) {
            Some(Earlier { texture, shape, missed }) => {
                Physical::Texture { texture, shape, missed, lifetime: Lifetime::Kept }
            }
            None => Physical::Absent(NoMemory::NoHistory),
        }
    }
}

/// Returns the number of mip levels that a texture must have for an access. Shaders that sample all levels accept
/// fewer, copies do not.
fn levels_for(access: &Access, mips: u32) -> u32 {
    let levels = access.range.mip_range(mips);
    let all = access.kind == AccessKind::Sampled && access.range.mips == u8::MAX;
    if all { levels.start + 1 } else { levels.end }
}

/// Returns the physical resource for a placed resource.
fn in_arena(plan: &Plan, resource: ResourceId, arena: Option<&Arena>, at: usize) -> Physical {
    let texture = arena.and_then(|arena| arena.texture(at));
    let buffer = arena.and_then(|arena| arena.buffer(at));
    match (texture, buffer, plan.graph().resources()[resource.index()].desc) {
        (Some((texture, shape)), ..) => {
            Physical::Texture { texture: texture.clone(), shape, missed: Some(0), lifetime: Lifetime::Kept }
        }
        (None, Some(buffer), Desc::Buffer(b)) => {
            Physical::Buffer { buffer: buffer.clone(), bytes: b.bytes(plan.frame()) }
        }
        _ => Physical::Absent(NoMemory::NotRealized),
    }
}

fn external(plan: &Plan, resource: ResourceId, imports: &Imports) -> Result<Physical, ExecuteError> {
    Ok(match plan.graph().resources()[resource.index()].desc {
        Desc::Texture(desc) => {
            let (texture, lifetime) = imports.find_texture(plan, resource)?;
            let mut shape = PhysicalTextureDesc::new(&desc, plan.frame(), Usage::NONE, false);
            shape.usage = texture.usage();
            Physical::Texture { texture: texture.clone(), shape, missed: Some(0), lifetime }
        }
        Desc::Buffer(desc) => {
            Physical::Buffer { buffer: imports.find_buffer(plan, resource)?.clone(), bytes: desc.bytes(plan.frame()) }
        }
    })
}
