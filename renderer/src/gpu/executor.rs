//! Executing frames on a device, and everything that is kept from one to the next.

use super::bindings::BindGroupCache;
use super::cx::Caches;
use super::device::Gpu;
use super::error::ExecuteError;
use super::history::Histories;
use super::imports::{Imports, Lifetime};
use super::objects::ObjectCounts;
use super::pipelines::Pipelines;
use super::pool::{Pool, PoolCounts};
use super::realize::{Physical, Realized};
use super::samplers::SamplerCache;
use super::shape::{BufferShape, TextureShape};
use super::steps::{Extra, Steps};
use super::timing::Timing;
use super::trouble::{DeviceError, Scopes};
use super::uniforms::Uniforms;
use super::views::{CacheCounts, ViewCache};
use crate::backend;
use crate::frame::Frame;
use framegraph::{AccessKind, Buffer, Counts, Join, PassId, Plan, ResourceId, Texture};
use std::time::Instant;

/// Choices of an executor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExecutorOptions {
    /// Frames after which a texture, buffer, view or bind group that nobody used is given up. The default of 30 is half a
    /// second at 60 frames a second: longer than a toggle or a drag of the window's edge.
    pub max_age: u64,
    /// Measure GPU times, where the device can.
    pub timing: bool,
    /// Write down the times of every frame ([`Timing::trace`]), beside the statistics.
    pub trace: bool,
    /// Fill contents that may be anything with a loud pattern, to find passes that read what nobody wrote.
    pub poison: bool,
}

impl Default for ExecutorOptions {
    fn default() -> Self {
        Self { max_age: 30, timing: true, trace: false, poison: false }
    }
}

/// Executes frames on one device. Pools, caches, histories and measurements live as long as it does.
#[derive(Debug)]
pub struct Executor {
    pub(super) gpu: Gpu,
    pub(super) options: ExecutorOptions,
    pub(super) caches: Caches,
    pub(super) textures: Pool<TextureShape>,
    pub(super) buffers: Pool<BufferShape>,
    pub(super) histories: Histories,
    pub(super) realized: Realized,
    pub(super) timing: Timing,
    pub(super) executed: Counts,
    /// Fills of the frame executed last that poisoning added.
    pub(super) poisoned: u32,
    /// By access of the graph: whether a recorder looked it up.
    pub(super) touched: Vec<bool>,
}

/// An access that a pass declared and its recorder did not look up: a view nobody bound, perhaps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnusedAccess {
    /// The pass.
    pub pass: PassId,
    /// What it declared to touch.
    pub resource: ResourceId,
    /// How.
    pub kind: AccessKind,
}

impl Executor {
    /// An executor with the default options.
    pub fn new(gpu: &Gpu) -> Self {
        Self::with(gpu, ExecutorOptions::default())
    }

    /// An executor.
    pub fn with(gpu: &Gpu, options: ExecutorOptions) -> Self {
        let caches = Caches {
            views: ViewCache::default(),
            groups: BindGroupCache::default(),
            samplers: SamplerCache::default(),
            pipelines: Pipelines::default(),
            uniforms: Uniforms::new(&gpu.device),
        };
        Self {
            gpu: gpu.clone(),
            options,
            caches,
            textures: Pool::new(options.max_age),
            buffers: Pool::new(options.max_age),
            histories: Histories::default(),
            realized: Realized::default(),
            timing: Timing::new(options.timing, options.trace),
            executed: Counts::default(),
            poisoned: 0,
            touched: Vec::new(),
        }
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Executes a frame: `plan` is compiled from `frame` as it is declared now (`framegraph::recompile` sees to that),
    /// `world` is handed to the recorders, `imports` says what the graph's imports stand for.
    ///
    /// Returns when the commands are submitted, not when the GPU is done.
    ///
    /// # Errors
    /// [`ExecuteError`]. Nothing of the frame reached the GPU then, histories did not move, and the next frame starts
    /// clean.
    pub fn execute<W: ?Sized + 'static>(
        &mut self,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
    ) -> Result<(), ExecuteError> {
        if !frame.graph().same_as(plan.graph()) {
            return Err(ExecuteError::OtherPlan);
        }
        self.run(plan, frame, world, imports, None)
    }

    /// As [`Executor::execute`], of a plan whose graph may have one pass more than the frame, and may lack others: that of
    /// an inspection.
    pub(crate) fn run<W: ?Sized + 'static>(
        &mut self,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
        extra: Option<Extra<'_>>,
    ) -> Result<(), ExecuteError> {
        self.gpu.poll()?;
        self.caches.views.begin_frame(self.options.max_age);
        self.caches.groups.begin_frame(self.options.max_age);
        self.caches.uniforms.begin_frame();
        self.executed = Counts::default();
        self.poisoned = 0;
        self.touched.clear();
        self.touched.resize(plan.graph().accesses().len(), false);
        self.timing.begin_frame(&self.gpu, plan);

        let begun = Instant::now();
        let scopes = Scopes::open(&self.gpu.device);
        self.timing.was_in_wgpu(begun);
        let ran = backend::run(&mut Steps::new(self, imports, extra), plan, frame, world);
        let begun = Instant::now();
        let caught = scopes.close("a frame").and_then(|()| self.gpu.trouble().check("executing a frame"));
        self.timing.was_in_wgpu(begun);
        if let Err(error) = caught {
            self.forget_frame();
            let error = match error {
                DeviceError::OutOfMemory { .. } => DeviceError::OutOfMemory { doing: self.memory_asked(plan) },
                other => other,
            };
            // What a recorder said is nearer to the cause than what wgpu refused because of it.
            return Err(ran.err().unwrap_or(ExecuteError::Device(error)));
        }
        ran?;
        self.timing.submitted();
        self.histories.advance();
        self.give_up();
        Ok(())
    }

    /// What a frame asks of the device's memory, in words.
    fn memory_asked(&self, plan: &Plan) -> String {
        let mib = |bytes: u64| bytes as f64 / f64::from(1 << 20);
        let memory = plan.memory();
        let largest = plan.graph().resource_ids().max_by_key(|r| plan.resources()[r.index()].bytes);
        let largest = largest.map_or_else(String::new, |resource| {
            let bytes = plan.resources()[resource.index()].bytes;
            format!(", {:.1} MiB of them for `{}`", mib(bytes), plan.graph().resource_name(resource))
        });
        let asked = mib(memory.bytes.saturating_add(memory.own_bytes));
        format!("making a frame's textures and buffers ({asked:.1} MiB{largest}) on {}", self.gpu.describe())
    }

    /// After the device refused something: objects made in this frame may be no good, so none that it used is kept.
    fn forget_frame(&mut self) {
        let Self { caches, textures, buffers, realized, .. } = self;
        realized.clear();
        caches.views.clear();
        caches.groups.clear();
        textures.forget_frame(|_| ());
        buffers.forget_frame(|_| ());
    }

    /// Gives up what has aged, and what was lent for this frame alone.
    fn give_up(&mut self) {
        let Self { caches: Caches { views, groups, .. }, textures, buffers, realized, .. } = self;
        textures.evict(|texture| {
            views.forget(texture);
            groups.forget(texture);
        });
        buffers.evict(|_| ());
        for physical in &mut realized.resources {
            if let Physical::Texture { texture, lifetime: Lifetime::Frame, .. } = physical {
                views.forget(texture);
                groups.forget(texture);
                *physical = Physical::Absent("it was lent for the frame alone");
            }
        }
    }

    /// The physical texture behind any version of `handle`, as the frame executed last left it; `None` when it has none.
    /// An exported texture stays as it is until the next frame.
    pub fn texture(&self, plan: &Plan, handle: Texture) -> Option<&wgpu::Texture> {
        self.texture_at(plan.graph().resource_of(handle)?)
    }

    /// As [`Executor::texture`], by the row of the graph: for graphs from files, whose resources are found by name.
    pub fn texture_at(&self, resource: ResourceId) -> Option<&wgpu::Texture> {
        match self.realized.get(resource) {
            Physical::Texture { texture, .. } => Some(texture),
            _ => None,
        }
    }

    /// As [`Executor::texture`], for a buffer.
    pub fn buffer(&self, plan: &Plan, handle: Buffer) -> Option<&wgpu::Buffer> {
        self.buffer_at(plan.graph().resource_of_buffer(handle)?)
    }

    /// As [`Executor::texture_at`], for a buffer.
    pub fn buffer_at(&self, resource: ResourceId) -> Option<&wgpu::Buffer> {
        match self.realized.get(resource) {
            Physical::Buffer { buffer, .. } => Some(buffer),
            _ => None,
        }
    }

    /// What the frame executed last really did, counted where wgpu was told; to be compared with `plan.counts()`.
    pub fn executed(&self) -> Counts {
        self.executed
    }

    /// How often the frame executed last filled contents that may be anything with a loud pattern; 0 unless it was asked to
    /// ([`ExecutorOptions::poison`]). These fills are no part of [`Executor::executed`].
    pub fn poisoned(&self) -> u32 {
        self.poisoned
    }

    /// Objects made since the beginning.
    pub fn objects(&self) -> ObjectCounts {
        ObjectCounts {
            textures: self.textures.counts().created,
            histories: self.histories.created(),
            buffers: self.buffers.counts().created,
            uniform_buffers: self.caches.uniforms.created(),
            views: self.caches.views.counts().created,
            bind_groups: self.caches.groups.counts().created,
            samplers: self.caches.samplers.created(),
            pipelines: self.caches.pipelines.counts().created,
            shader_modules: self.caches.pipelines.modules().created(),
        }
    }

    /// How the pool of textures does.
    pub fn texture_pool(&self) -> PoolCounts {
        self.textures.counts()
    }

    /// How the pool of buffers does.
    pub fn buffer_pool(&self) -> PoolCounts {
        self.buffers.counts()
    }

    /// How the caches of views, bind groups and pipelines do.
    pub fn caches(&self) -> [(&'static str, CacheCounts); 3] {
        let Caches { views, groups, pipelines, .. } = &self.caches;
        [("views", views.counts()), ("bind groups", groups.counts()), ("pipelines", pipelines.counts())]
    }

    /// Times of steps and frames.
    pub fn timing(&self) -> &Timing {
        &self.timing
    }

    /// Reads the times that have arrived since the last frame, and returns them.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn catch_up(&mut self) -> Result<&Timing, ExecuteError> {
        self.timing.catch_up(&self.gpu)?;
        Ok(&self.timing)
    }

    /// Becomes an executor of the next frame of `other`: sees histories as that left them and poisons as it does. What is
    /// written to a history here is what `other` overwrites in its next frame.
    pub(crate) fn borrow(&mut self, other: &Self) {
        self.histories = other.histories.clone();
        self.options.poison = other.options.poison;
    }

    /// Forgets the earlier frames of the history of that full name: after a camera cut.
    pub fn reset_history(&mut self, name: &str) {
        self.histories.reset(name);
    }

    /// Says that the camera was cut: what earlier frames showed has nothing to do with the next one, whose recorders find
    /// all histories not valid, as in a first frame.
    pub fn cut(&mut self) {
        self.reset_histories();
    }

    /// Forgets the earlier frames of all histories.
    pub fn reset_histories(&mut self) {
        self.histories.reset_all();
    }

    /// What the passes of the frame executed last declared and did not look up. Attachments are used by being attached.
    pub fn unused_accesses(&self, plan: &Plan) -> impl Iterator<Item = UnusedAccess> {
        let graph = plan.graph();
        let recorded = plan.step_passes().iter().filter(|m| m.join != Join::Inlined);
        recorded.flat_map(move |member| {
            let rows = graph.passes()[member.pass.index()].accesses.range();
            rows.filter_map(move |row| {
                let access = graph.accesses()[row];
                let unused = !access.kind.is_attachment() && self.touched.get(row) == Some(&false);
                unused.then_some(UnusedAccess { pass: member.pass, resource: access.resource, kind: access.kind })
            })
        })
    }
}
