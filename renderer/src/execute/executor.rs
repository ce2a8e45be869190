//! Executing frames on a device, and everything that is kept from one to the next.

use crate::cache::CacheCounts;
use crate::device::error::{DeviceError, ErrorScopes};
use crate::device::gpu::Gpu;
use crate::execute::error::{ExecuteError, MemoryAsked};
use crate::execute::object_counts::ObjectCounts;
use crate::execute::prepared::{Caches, Prepared};
use crate::execute::recording::Recording;
use crate::execute::steps::{Extra, Passes, record_step};
use crate::frame::Frame;
use crate::measure::timing::Timing;
use crate::named::Named;
use crate::resources::history::Histories;
use crate::resources::imports::{Imports, Lifetime};
use crate::resources::no_memory::NoMemory;
use crate::resources::physical::{PhysicalBufferDesc, PhysicalTextureDesc};
use crate::resources::pool::{Pool, PoolCounts};
use crate::resources::realize::{Physical, Realized, Sources};
use framegraph::{AccessKind, Buffer, Counts, Join, PassId, Plan, ResourceId, Texture};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;
use wgpu::CommandEncoderDescriptor;

/// Options of an executor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExecutorOptions {
    /// Frames after which a texture, buffer, view or bind group that no frame used is dropped. The default of 30 is half a
    /// second at 60 frames a second: longer than a toggle or a drag of the window's edge.
    pub max_age: u64,
    /// Measure GPU times, where the device can.
    pub timing: bool,
    /// Write down the times of every frame ([`Timing::trace`]), beside the statistics.
    pub trace: bool,
    /// Fill undefined contents with NaN or magenta, to find passes that read what no pass wrote.
    pub poison: bool,
}

impl Default for ExecutorOptions {
    fn default() -> Self {
        Self { max_age: 30, timing: true, trace: false, poison: false }
    }
}

/// Executes frames on one device. Pools, caches, histories and measurements live as long as it does.
///
/// ```
/// use framegraph::{ClearValue, Extent, Format, Intent, Options, Plan, Scratch, TextureDesc, recompile};
/// use framegraph_wgpu::{Executor, Frame, Gpu, Imports, read_texture};
///
/// let gpu = Gpu::noop()?;
/// let mut executor = Executor::new(&gpu);
/// let (mut frame, mut plan, mut scratch) = (Frame::<()>::new(), Plan::new(), Scratch::new());
/// for _ in 0..3 {
///     // Declared anew each frame; nothing is compiled or allocated again while it stays the same.
///     frame.reset();
///     let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm);
///     let sky = frame.graph_mut().texture("sky", desc);
///     let clear = Intent::Clear(ClearValue::Color([0.2, 0.4, 0.8, 1.0]));
///     let sky = frame.add_fn("clear", |pass| pass.color(sky, clear), |_, _, _| Ok(()))?;
///     frame.graph_mut().readback(sky)?;
///     recompile(frame.graph(), &gpu.caps(), &Options::for_frame(64, 64), &mut scratch, &mut plan)?;
///     executor.execute(&plan, &frame, &(), &Imports::new())?;
///     let picture = executor.texture(&plan, sky).map(|texture| read_texture(&gpu, texture)).transpose()?;
///     assert_eq!(picture.map(|p| p.texels), Some([64, 64]));
/// }
/// assert_eq!(executor.objects().textures, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Executor {
    gpu: Gpu,
    options: ExecutorOptions,
    caches: Caches,
    recording: Recording,
    textures: Pool<PhysicalTextureDesc>,
    buffers: Pool<PhysicalBufferDesc>,
    histories: Histories,
    realized: Realized,
    timing: Timing,
    executed: Counts,
    /// By access of the graph: whether a recorder looked it up.
    touched: Vec<AtomicBool>,
}

/// An access that a pass declared and its recorder did not look up, so that it was probably not bound.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnusedAccess {
    /// The pass that declared it.
    pub pass: PassId,
    /// The resource that it declared to access.
    pub resource: ResourceId,
    /// The kind of access.
    pub kind: AccessKind,
}

impl Executor {
    /// An executor with the default options.
    pub fn new(gpu: &Gpu) -> Self {
        Self::with(gpu, ExecutorOptions::default())
    }

    /// An executor with these options.
    pub fn with(gpu: &Gpu, options: ExecutorOptions) -> Self {
        Self {
            gpu: gpu.clone(),
            options,
            caches: Caches::default(),
            recording: Recording::new(&gpu.device),
            textures: Pool::new(options.max_age),
            buffers: Pool::new(options.max_age),
            histories: Histories::default(),
            realized: Realized::default(),
            timing: Timing::new(options.timing, options.trace),
            executed: Counts::default(),
            touched: Vec::new(),
        }
    }

    /// The device that it executes on.
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
        self.caches.begin_frame(self.options.max_age);
        self.recording.begin_frame();
        self.executed = Counts::default();
        self.timing.begin_frame(&self.gpu, plan);

        let begun = Instant::now();
        let scopes = ErrorScopes::open(&self.gpu.device);
        self.recording.in_wgpu += begun.elapsed();
        let ran = self.prepare(plan, imports).and_then(|()| self.record(plan, &Passes { frame, world, extra }));
        let begun = Instant::now();
        let caught = scopes.close("a frame").and_then(|()| self.gpu.errors().check("executing a frame"));
        self.recording.in_wgpu += begun.elapsed();
        if let Err(error) = caught {
            self.forget_frame();
            let told = || match error {
                DeviceError::OutOfMemory { .. } => ExecuteError::OutOfMemory(Box::new(self.memory_asked(plan))),
                other => ExecuteError::Device(other),
            };
            // What a recorder said is nearer to the cause than what wgpu refused because of it.
            return Err(ran.err().unwrap_or_else(told));
        }
        ran?;
        self.timing.submitted(&self.recording);
        self.histories.advance();
        self.give_up();
        Ok(())
    }

    /// Makes, or finds again, every texture and buffer of the frame.
    fn prepare(&mut self, plan: &Plan, imports: &Imports) -> Result<(), ExecuteError> {
        let Self { gpu, textures, buffers, histories, realized, options, touched, .. } = self;
        touched.clear();
        touched.resize_with(plan.graph().accesses().len(), AtomicBool::default);
        let poison = options.poison;
        realized.realize(plan, &mut Sources { gpu, textures, buffers, histories, imports, poison })
    }

    /// Records all steps, and submits them.
    fn record<W: ?Sized + 'static>(&mut self, plan: &Plan, passes: &Passes<'_, W>) -> Result<(), ExecuteError> {
        let Self { gpu, caches, realized, timing, touched, options, recording, executed, .. } = self;
        let descriptor = CommandEncoderDescriptor { label: Some("frame") };
        let mut encoder = recording.in_wgpu(|| gpu.device.create_command_encoder(&descriptor));
        let frame = &Prepared { gpu, plan, realized, caches, timing, touched, poison: options.poison };
        let mut steps = plan.step_ids();
        let recorded = steps.try_for_each(|step| record_step(frame, passes, step, recording, &mut encoder));
        *executed = recording.executed;
        executed.memoryless = realized.memoryless();
        recorded?;
        executed.culled = plan.graph().passes().len() as u32 - executed.passes;
        let begun = Instant::now();
        timing.resolve(&mut encoder);
        let commands = encoder.finish();
        recording.uniforms.upload(&gpu.queue);
        gpu.queue.submit([commands]);
        recording.in_wgpu += begun.elapsed();
        Ok(())
    }

    /// What a frame asks of the device's memory.
    fn memory_asked(&self, plan: &Plan) -> MemoryAsked {
        let (memory, bytes) = (plan.memory(), |r: ResourceId| plan.resources()[r.index()].bytes);
        let largest = plan.graph().resource_ids().max_by_key(|r| bytes(*r));
        MemoryAsked {
            bytes: memory.bytes.saturating_add(memory.own_bytes),
            largest: largest.map(|r| (Named::resource(plan, r), bytes(r))),
            adapter: self.gpu.info().clone(),
        }
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

    /// Drops objects that no recent frame used, and what was lent for this frame alone.
    fn give_up(&mut self) {
        let Self { caches, textures, buffers, realized, .. } = self;
        textures.evict(|texture| caches.forget(texture));
        buffers.evict(|_| ());
        for physical in &mut realized.resources {
            if let Physical::Texture { texture, lifetime: Lifetime::Frame, .. } = physical {
                caches.forget(texture);
                *physical = Physical::Absent(NoMemory::Lent);
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

    /// What the frame executed last really did, counted where wgpu is called; to be compared with `plan.counts()`.
    pub fn executed(&self) -> Counts {
        self.executed
    }

    /// How many fills of undefined contents the frame executed last added; 0 unless it was asked to
    /// ([`ExecutorOptions::poison`]). These fills are no part of [`Executor::executed`].
    pub fn poisoned(&self) -> u32 {
        self.recording.poisoned
    }

    /// Objects made since the beginning.
    pub fn objects(&self) -> ObjectCounts {
        ObjectCounts {
            textures: self.textures.counts().created,
            histories: self.histories.created(),
            buffers: self.buffers.counts().created,
            uniform_buffers: self.recording.uniforms.created(),
            views: self.caches.views.counts().created,
            bind_groups: self.caches.groups.counts().created,
            samplers: self.caches.samplers.created(),
            pipelines: self.caches.pipelines.counts().created,
            shader_modules: self.caches.pipelines.modules().created(),
        }
    }

    /// Hits, creations and memory of the pool of textures.
    pub fn texture_pool(&self) -> PoolCounts {
        self.textures.counts()
    }

    /// Hits and creations of the caches of views, bind groups and pipelines.
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

    /// Forgets the earlier frames of all histories: after a camera cut, what they show has nothing to do with the next
    /// frame. Its recorders find all of them not valid, as in a first frame.
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
                let untouched = |touched: &AtomicBool| !touched.load(Ordering::Relaxed);
                let unused = !access.kind.is_attachment() && self.touched.get(row).is_some_and(untouched);
                unused.then_some(UnusedAccess { pass: member.pass, resource: access.resource, kind: access.kind })
            })
        })
    }
}

#[cfg(test)]
mod tests;
