//! Executing frames on a device, and everything that is kept from one to the next.

mod histories;
mod placing;
#[cfg(feature = "threads")]
mod record_on;
mod recorded;
mod results;
mod upkeep;
mod warm_up;

pub use placing::Allocated;
pub use results::UnusedAccess;
pub use warm_up::WarmUp;

use crate::device::error::{DeviceError, ErrorScopes};
use crate::device::gpu::Gpu;
use crate::execute::blame::{not_submitted, refused_pass};
use crate::execute::commands::FrameCommands;
use crate::execute::error::{ExecuteError, MemoryAsked, RecordError};
use crate::execute::prepared::{Caches, Prepared};
use crate::execute::recording::Recording;
use crate::execute::steps::Passes;
use crate::execute::threads::{Threads, record_part};
use crate::frame::Frame;
use crate::frame_key::FrameKey;
use crate::measure::timing::Timing;
use crate::named::Named;
use crate::placed::arenas::Arenas;
use crate::resources::history::Histories;
use crate::resources::imports::Imports;
use crate::resources::physical::{PhysicalBufferDesc, PhysicalTextureDesc};
use crate::resources::pool::{Limits, Pool};
use crate::resources::realize::{Realized, Sources};
use framegraph::{Counts, Plan, ResourceId, StepId};
use std::sync::atomic::AtomicBool;
use wgpu::SubmissionIndex;

/// Options of an executor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExecutorOptions {
    /// Frames after which a texture, buffer, view or bind group that no frame used is dropped. The default of 30 is half a
    /// second at 60 frames a second: longer than a toggle or a drag of the window's edge. A history that no frame
    /// writes for so long is dropped too.
    pub max_age: u64,
    /// How many times the bytes of a frame's plan the pools and placed blocks of memory may hold, 3 by default: while a window is dragged, the sizes that
    /// no frame asked for the longest go first ([`PoolCounts::budget_bytes`](crate::PoolCounts::budget_bytes)). What the last two frames used stays.
    pub pool_budget: u32,
    /// Frames after which a pipeline and a shader module that no frame asked for are dropped; 36,000 by default, ten minutes
    /// at 60 frames a second.
    pub max_pipeline_age: u64,
    /// Measure the times of steps: on the CPU, and on the GPU where the device can. Without it, and without `trace`, the CPU
    /// time of whole frames is all that is measured, and a frame asks the clock twice.
    pub timing: bool,
    /// Write down the times of every frame ([`Timing::trace`]), beside the statistics.
    pub trace: bool,
    /// Fill undefined contents with NaN or magenta, to find passes that read what no pass wrote.
    pub poison: bool,
}

impl Default for ExecutorOptions {
    fn default() -> Self {
        let (max_age, pool_budget, max_pipeline_age) = (30, 3, 36_000);
        Self { max_age, pool_budget, max_pipeline_age, timing: true, trace: false, poison: false }
    }
}

impl ExecutorOptions {
    fn limits(&self) -> Limits {
        Limits { max_age: self.max_age, budget: self.pool_budget }
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
    threads: Threads,
    textures: Pool<PhysicalTextureDesc>,
    buffers: Pool<PhysicalBufferDesc>,
    histories: Histories,
    arenas: Arenas,
    realized: Realized,
    timing: Timing,
    executed: Counts,
    /// A frame was recorded, and nobody said that it was submitted.
    unsubmitted: bool,
    /// By access of the graph: whether a recorder looked it up.
    touched: Vec<AtomicBool>,
}

impl Executor {
    /// An executor with the default options.
    pub fn new(gpu: &Gpu) -> Self {
        Self::with(gpu, ExecutorOptions::default())
    }

    /// An executor with these options.
    pub fn with(gpu: &Gpu, options: ExecutorOptions) -> Self {
        let limits = options.limits();
        Self {
            gpu: gpu.clone(),
            options,
            caches: Caches::default(),
            recording: Recording::new(&gpu.device, options.timing || options.trace),
            threads: Threads::default(),
            textures: Pool::new(limits),
            buffers: Pool::new(limits),
            histories: Histories::default(),
            arenas: Arenas::default(),
            realized: Realized::default(),
            timing: Timing::new(options.timing, options.trace),
            executed: Counts::default(),
            unsubmitted: false,
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
    /// Returns when the commands are submitted, not when the GPU is done: the index is what [`wgpu::PollType::Wait`] waits
    /// for.
    ///
    /// # Errors
    /// [`ExecuteError`]. Nothing of the frame reached the GPU then, histories did not move, and the next frame starts
    /// clean.
    pub fn execute<W: ?Sized + Sync + 'static>(
        &mut self,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
    ) -> Result<SubmissionIndex, ExecuteError> {
        let queue = self.gpu.queue.clone();
        self.execute_with(plan, frame, world, imports, |commands| commands.submit(&queue, [], []))
    }

    /// As [`Executor::execute`], submitted by the caller: `submit` gets the frame's commands and submits them on the
    /// device's queue, with commands of its own before and behind them if it wants. What wgpu refuses meanwhile is this
    /// frame's error.
    ///
    /// ```
    /// # use framegraph::{ClearValue, Extent, Format, Intent, Options, Plan, Scratch, TextureDesc, compile};
    /// # use framegraph_wgpu::{Executor, Frame, Gpu, Imports};
    /// # let gpu = Gpu::noop()?;
    /// # let (mut executor, mut frame, mut plan) = (Executor::new(&gpu), Frame::<()>::new(), Plan::new());
    /// # let sky = frame.graph_mut().texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
    /// # let clear = Intent::Clear(ClearValue::BLACK);
    /// # let sky = frame.add_fn("clear", |pass| pass.color(sky, clear), |_, _, _| Ok(()))?;
    /// # frame.graph_mut().export(sky)?;
    /// # compile(frame.graph(), &gpu.caps(), &Options::for_frame(8, 8), &mut Scratch::new(), &mut plan)?;
    /// let own = gpu.device.create_command_encoder(&Default::default()).finish();
    /// let queue = gpu.queue.clone();
    /// let submitted = executor.execute_with(&plan, &frame, &(), &Imports::new(), |graph| {
    ///     graph.submit(&queue, [], [own])
    /// })?;
    /// gpu.device.poll(wgpu::PollType::Wait { submission_index: Some(submitted), timeout: None })?;
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Executor::execute`]; `submit` is not called when recording failed.
    pub fn execute_with<W: ?Sized + Sync + 'static>(
        &mut self,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
        submit: impl FnOnce(FrameCommands) -> SubmissionIndex,
    ) -> Result<SubmissionIndex, ExecuteError> {
        check(plan, frame)?;
        self.run(plan, &Passes { frame, world, extra: None }, imports, submit)
    }

    /// As [`Executor::execute_with`], of a plan whose graph may have one pass more than the frame, and may lack others: that
    /// of an inspection.
    pub(crate) fn run<W: ?Sized + Sync + 'static>(
        &mut self,
        plan: &Plan,
        passes: &Passes<'_, W>,
        imports: &Imports,
        submit: impl FnOnce(FrameCommands) -> SubmissionIndex,
    ) -> Result<SubmissionIndex, ExecuteError> {
        let commands = self.record_frame(plan, passes, imports, None)?;
        let begun = self.recording.now();
        let watch = self.gpu.watch("submitting a frame");
        self.upload();
        let index = submit(commands);
        let caught = watch.end(self.gpu.errors());
        self.recording.took_in_wgpu(begun);
        if let Err(error) = caught {
            let told = match error {
                DeviceError::Refused { message, .. } => not_submitted(&self.gpu, plan, imports, message),
                other => self.told(plan, other),
            };
            self.forget_frame();
            return Err(told);
        }
        self.end_frame();
        Ok(index)
    }

    /// Sends the constants that recorders pushed, ahead of what is submitted next.
    fn upload(&self) {
        self.recording.uniforms.upload(&self.gpu.queue);
        self.threads.upload(&self.gpu.queue);
    }

    /// Ends a frame that was submitted.
    fn end_frame(&mut self) {
        self.timing.submitted(&self.recording);
        self.histories.advance(self.options.max_age);
        self.give_up();
    }

    /// Records a frame. `recorded` is told each step that is done, and how many pipelines were made until then; one thread
    /// records all of them then.
    fn record_frame<W: ?Sized + Sync + 'static>(
        &mut self,
        plan: &Plan,
        passes: &Passes<'_, W>,
        imports: &Imports,
        recorded: Option<&mut dyn FnMut(StepId, u64)>,
    ) -> Result<FrameCommands, ExecuteError> {
        // Submitting the frame before has looked for finished work already; times are read back.
        if self.timing.is_enabled() {
            self.gpu.poll()?;
        } else {
            self.gpu.errors().check("a frame")?;
        }
        self.unsubmitted = false;
        self.caches.begin_frame(self.options.max_age, self.options.max_pipeline_age);
        self.executed = Counts::default();
        self.timing.begin_frame(&self.gpu, plan);
        let timed = self.threads.begin_frame(plan, self.timing.plan(), self.options.max_age);
        self.recording.begin_frame(timed, self.options.max_age);

        let watch = self.recording.in_wgpu(|| self.gpu.watch("a frame"));
        let mut elsewhere = Ok(());
        let prepared = self.prepare(plan, passes.frame.key(), imports);
        let ran = prepared.and_then(|()| self.record_steps(plan, passes, recorded, &mut elsewhere));
        let begun = self.recording.now();
        let caught = watch.end(self.gpu.errors()).and(elsewhere);
        self.recording.took_in_wgpu(begun);
        match (ran, caught) {
            (ran, Ok(())) => ran,
            (Err(said), Err(error)) => {
                self.forget_frame();
                Err(if follows(&said, &error) { self.told(plan, error) } else { said })
            }
            (Ok(_), Err(error)) => {
                self.forget_frame();
                let blamed = matches!(error, DeviceError::Refused { .. }).then(|| self.blame(plan, passes, imports));
                Err(blamed.flatten().unwrap_or_else(|| self.told(plan, error)))
            }
        }
    }

    /// What the device's error means for the frame.
    fn told(&self, plan: &Plan, error: DeviceError) -> ExecuteError {
        match error {
            DeviceError::OutOfMemory { .. } => ExecuteError::OutOfMemory(Box::new(self.memory_asked(plan))),
            other => ExecuteError::Device(other),
        }
    }

    /// The pass whose commands wgpu refused, found by recording the frame once more, pass by pass; nothing of it is
    /// submitted. None where the fault is not in one pass.
    fn blame<W: ?Sized + Sync + 'static>(
        &mut self,
        plan: &Plan,
        passes: &Passes<'_, W>,
        imports: &Imports,
    ) -> Option<ExecuteError> {
        let scopes = ErrorScopes::open(&self.gpu.device);
        let prepared = self.prepare(plan, passes.frame.key(), imports);
        let refused = scopes.close("a texture").is_ok() && prepared.is_ok();
        let Self { gpu, caches, realized, timing, touched, options, recording, .. } = self;
        let frame = &Prepared { gpu, plan, realized, caches, timing, touched, poison: options.poison };
        let blamed = refused.then(|| refused_pass(frame, passes, recording)).flatten();
        self.forget_frame();
        blamed.map(|(pass, message)| ExecuteError::Refused { pass: Named::pass(plan, pass), message })
    }

    /// Makes, or finds again, every texture and buffer of the frame.
    fn prepare(&mut self, plan: &Plan, owner: &FrameKey, imports: &Imports) -> Result<(), ExecuteError> {
        let Self { gpu, textures, buffers, histories, arenas, realized, options, touched, .. } = self;
        touched.clear();
        touched.resize_with(plan.graph().accesses().len(), AtomicBool::default);
        let poison = options.poison;
        realized.realize(plan, &mut Sources { gpu, owner, textures, buffers, histories, imports, arenas, poison })
    }

    /// Records all steps. What wgpu refuses on other threads than this one is put into `elsewhere`.
    fn record_steps<W: ?Sized + Sync + 'static>(
        &mut self,
        plan: &Plan,
        passes: &Passes<'_, W>,
        recorded: Option<&mut dyn FnMut(StepId, u64)>,
        elsewhere: &mut Result<(), DeviceError>,
    ) -> Result<FrameCommands, ExecuteError> {
        let Self { gpu, caches, arenas, realized, timing, touched, options, recording, threads, executed, .. } = self;
        let frame = &Prepared { gpu, plan, realized, caches, timing, touched, poison: options.poison };
        let arenas = &*arenas;
        let alone = recorded.is_some();
        let shared = if alone { None } else { threads.record(frame, arenas, passes, recording, elsewhere) };
        let all = 0..plan.steps().len() as u32;
        let commands = shared.unwrap_or_else(|| record_part(frame, arenas, passes, all, recording, recorded));
        let commands = commands.map(|buffers| FrameCommands::new(buffers, arenas.submits_apart(gpu)));
        if !alone {
            threads.end_frame(recording);
        }
        *executed = recording.executed;
        executed.memoryless = realized.memoryless();
        let commands = commands?;
        executed.culled = plan.graph().passes().len() as u32 - executed.passes;
        Ok(commands)
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
}

/// Whether a plan is that of a frame.
fn check<W: ?Sized + 'static>(plan: &Plan, frame: &Frame<W>) -> Result<(), ExecuteError> {
    if frame.graph().same_as(plan.graph()) { Ok(()) } else { Err(ExecuteError::OtherPlan) }
}

/// Whether what was `said` while recording follows from the device's `error`, such as a view of a texture that there is no
/// memory for. Else what a recorder said is nearer to the cause than what wgpu refused because of it.
fn follows(said: &ExecuteError, error: &DeviceError) -> bool {
    let of_a_view =
        matches!(said, ExecuteError::Device(_) | ExecuteError::Record { error: RecordError::View { .. }, .. });
    of_a_view || matches!(error, DeviceError::OutOfMemory { .. } | DeviceError::Lost { .. })
}

#[cfg(test)]
mod tests;
