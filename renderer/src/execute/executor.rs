//! The executor: executes frames on a device and owns everything that is kept between frames.

mod eviction;
mod histories;
mod placing;
mod record;
#[cfg(feature = "threads")]
mod record_on;
mod results;
mod warm_up;

pub use placing::Allocated;
pub use results::UnusedAccess;
pub use warm_up::WarmUpProgress;

use crate::device::error::{DeviceError, ErrorScopes};
use crate::device::gpu::Gpu;
use crate::execute::blame::{not_submitted, refused_pass};
use crate::execute::commands::{CommandList, Destination, FrameCommands};
use crate::execute::error::{ExecuteError, MemoryRequest, RecordError};
use crate::execute::prepared::{Caches, Prepared};
use crate::execute::recording::Recording;
use crate::execute::steps::Passes;
use crate::execute::threads::{Threads, record_into, record_part};
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
use crate::spans::{executed, span};
use framegraph::{Counts, Plan, ResourceId};
use std::sync::atomic::AtomicBool;
use wgpu::SubmissionIndex;

/// Options of an executor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ExecutorOptions {
    /// Number of frames after which unused textures, buffers, views and bind groups are dropped. Also drops histories
    /// that were not written for as long. The default is 30, half a second at 60 frames per second, which outlasts
    /// toggling an option or resizing a window.
    pub max_age: u64,
    /// Maximum size of pools and memory blocks, as a multiple of the plan's memory; 3 by default. While a window is
    /// resized, the sizes that were unused for longest are dropped first
    /// ([`PoolCounts::budget_bytes`](crate::PoolCounts::budget_bytes)). Resources of the last two frames are always
    /// kept.
    pub pool_budget: u32,
    /// Number of frames after which unused pipelines and shader modules are dropped; 36,000 by default, ten minutes at
    /// 60 frames per second.
    pub max_pipeline_age: u64,
    /// Measures CPU times of steps, and GPU times if the device supports timestamps. Off by default, because it adds
    /// about a third to the execution of small frames; [`Executor::set_timing`] changes it later. If both `timing` and
    /// `trace` are off, only the CPU time of whole frames is measured, with two clock reads per frame.
    pub timing: bool,
    /// Measures times as `timing` does, and also stores those of every frame ([`Timing::trace`]).
    pub trace: bool,
    /// Fills undefined contents with NaN or magenta, to find passes that read contents no pass wrote.
    pub poison: bool,
}

impl Default for ExecutorOptions {
    fn default() -> Self {
        let (max_age, pool_budget, max_pipeline_age) = (30, 3, 36_000);
        Self { max_age, pool_budget, max_pipeline_age, timing: false, trace: false, poison: false }
    }
}

impl ExecutorOptions {
    fn limits(&self) -> Limits {
        Limits { max_age: self.max_age, budget: self.pool_budget }
    }
}

/// Executes frames on one device. Owns the pools, caches, histories and measurements.
///
/// ```
/// use framegraph::{ClearValue, Extent, Format, Intent, Options, Plan, Scratch, TextureDesc, recompile};
/// use framegraph_wgpu::{Executor, Frame, Gpu, Imports, read_texture};
///
/// let gpu = Gpu::noop()?;
/// let mut executor = Executor::new(&gpu);
/// let (mut frame, mut plan, mut scratch) = (Frame::<()>::new(), Plan::new(), Scratch::new());
/// for _ in 0..3 {
///     // Redeclared in each frame. While it stays the same, nothing is compiled or allocated again.
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
    /// A frame was recorded, and its submission was not reported yet.
    unsubmitted: bool,
    /// For each access of the graph, whether a recorder looked it up.
    touched: Vec<AtomicBool>,
}

impl Executor {
    /// Creates an executor with the default options.
    pub fn new(gpu: &Gpu) -> Self {
        Self::with(gpu, ExecutorOptions::default())
    }

    /// Creates an executor with the given options.
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

    /// Returns the device of the executor.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Executes a frame.
    ///
    /// `plan` must be compiled from the current declaration of `frame`, for example with `framegraph::recompile`.
    /// `world` is passed to the recorders, and `imports` has the resources behind the graph's imports.
    ///
    /// Returns when the commands are submitted, not when the GPU has finished. Wait for the returned index with
    /// [`wgpu::PollType::Wait`].
    ///
    /// # Errors
    /// Fails with [`ExecuteError`]. Nothing of the frame is submitted in that case, histories do not advance, and the
    /// next frame starts clean.
    pub fn execute<W: ?Sized>(
        &mut self,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
    ) -> Result<SubmissionIndex, ExecuteError> {
        let queue = self.gpu.queue.clone();
        self.execute_with(plan, frame, world, imports, |commands| commands.submit(&queue, [], []))
    }

    /// Executes a frame like [`Executor::execute`], but lets `submit` submit the commands.
    ///
    /// `submit` must submit them on the device's queue, and may add its own command buffers before and after them.
    /// Errors that wgpu reports during the submission are returned as errors of this frame.
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
    /// Fails like [`Executor::execute`]. If recording fails, `submit` is not called.
    pub fn execute_with<W: ?Sized>(
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

    /// Executes a frame like [`Executor::execute_with`]. For inspections, the plan's graph may lack passes of the frame
    /// and have one additional pass.
    pub(crate) fn run<W: ?Sized>(
        &mut self,
        plan: &Plan,
        passes: &Passes<'_, W>,
        imports: &Imports,
        submit: impl FnOnce(FrameCommands) -> SubmissionIndex,
    ) -> Result<SubmissionIndex, ExecuteError> {
        let commands = self.record_frame(plan, passes, imports, Destination::Own)?;
        let _span = span!("submit", command_buffers = commands.buffers());
        let begun = self.recording.now();
        let watch = self.gpu.watch("submitting a frame");
        self.upload();
        let index = submit(commands);
        let caught = watch.end(self.gpu.errors());
        self.recording.took_in_wgpu(begun);
        if let Err(error) = caught {
            let error = match error {
                DeviceError::Refused { message, .. } => not_submitted(&self.gpu, plan, imports, message),
                other => self.execute_error(plan, other),
            };
            self.discard_frame();
            return Err(error);
        }
        self.end_frame();
        Ok(index)
    }

    /// Uploads the uniforms of all recorders, before the next submission.
    fn upload(&self) {
        self.recording.uniforms.upload(&self.gpu.queue);
        self.threads.upload(&self.gpu.queue);
    }

    /// Ends a frame that was submitted.
    fn end_frame(&mut self) {
        self.timing.submitted(&self.recording);
        self.histories.advance(self.options.max_age);
        self.drop_unused();
    }

    /// Records a frame into `to`. The result has no command buffers if that is the caller's encoder.
    fn record_frame<W: ?Sized>(
        &mut self,
        plan: &Plan,
        passes: &Passes<'_, W>,
        imports: &Imports,
        to: Destination<'_>,
    ) -> Result<FrameCommands, ExecuteError> {
        let span = span!("frame"; steps, passes, loads, stores, loaded_bytes, stored_bytes);
        // Notices a lost device, and reads times that have arrived.
        self.gpu.poll()?;
        self.unsubmitted = false;
        self.caches.begin_frame(self.options.max_age, self.options.max_pipeline_age);
        self.executed = Counts::default();
        self.timing.begin_frame(&self.gpu, plan);
        let may_split = passes.frame.share().is_some();
        let timed = self.threads.begin_frame(plan, self.timing.plan(), may_split, self.options.max_age);
        self.recording.begin_frame(timed, self.options.max_age);

        let watch = self.recording.in_wgpu(|| self.gpu.watch("a frame"));
        let mut elsewhere = Ok(());
        let prepared = self.prepare(plan, passes.frame.key(), imports);
        let ran = prepared.and_then(|()| self.record_steps(plan, passes, to, &mut elsewhere));
        let begun = self.recording.now();
        let caught = watch.end(self.gpu.errors()).and(elsewhere);
        self.recording.took_in_wgpu(begun);
        executed(&span, plan);
        match (ran, caught) {
            (Ok(commands), Ok(())) => Ok(commands),
            (Err(said), Ok(())) => {
                self.end_loans();
                Err(said)
            }
            (Err(said), Err(error)) => {
                self.discard_frame();
                Err(if is_consequence(&said, &error) { self.execute_error(plan, error) } else { said })
            }
            (Ok(_), Err(error)) => {
                self.discard_frame();
                let blamed = matches!(error, DeviceError::Refused { .. }).then(|| self.blame(plan, passes, imports));
                Err(blamed.flatten().unwrap_or_else(|| self.execute_error(plan, error)))
            }
        }
    }

    /// Converts an error of the device to an error of the frame.
    fn execute_error(&self, plan: &Plan, error: DeviceError) -> ExecuteError {
        match error {
            DeviceError::OutOfMemory { .. } => ExecuteError::OutOfMemory(Box::new(self.memory_request(plan))),
            other => ExecuteError::Device(other),
        }
    }

    /// Records the frame again, pass by pass, to find the pass whose commands wgpu rejected. Submits nothing. Returns
    /// `None` if no single pass is at fault.
    fn blame<W: ?Sized>(&mut self, plan: &Plan, passes: &Passes<'_, W>, imports: &Imports) -> Option<ExecuteError> {
        let scopes = ErrorScopes::open(&self.gpu.device);
        let prepared = self.prepare(plan, passes.frame.key(), imports);
        let refused = scopes.close("a texture").is_ok() && prepared.is_ok();
        let Self { gpu, caches, realized, timing, touched, options, recording, threads, .. } = self;
        let workers = threads.workers().cloned();
        let (workers, poison) = (workers.as_ref(), options.poison);
        let frame = &Prepared { gpu, plan, realized, caches, timing, workers, touched, poison };
        let blamed = refused.then(|| refused_pass(frame, passes, recording)).flatten();
        self.discard_frame();
        blamed.map(|(pass, message)| ExecuteError::Refused { pass: Named::pass(plan, pass), message })
    }

    /// Creates or reuses all textures and buffers of the frame.
    fn prepare(&mut self, plan: &Plan, owner: &FrameKey, imports: &Imports) -> Result<(), ExecuteError> {
        let _span =
            span!("realize", resources = plan.resources().len(), bytes = plan.memory().bytes + plan.memory().own_bytes);
        let Self { gpu, textures, buffers, histories, arenas, realized, options, touched, .. } = self;
        touched.clear();
        touched.resize_with(plan.graph().accesses().len(), AtomicBool::default);
        let poison = options.poison;
        realized.realize(plan, &mut Sources { gpu, owner, textures, buffers, histories, imports, arenas, poison })
    }

    /// Records all steps. Errors on other threads are stored in `elsewhere`.
    fn record_steps<W: ?Sized>(
        &mut self,
        plan: &Plan,
        passes: &Passes<'_, W>,
        to: Destination<'_>,
        elsewhere: &mut Result<(), DeviceError>,
    ) -> Result<FrameCommands, ExecuteError> {
        let Self { gpu, caches, arenas, realized, timing, touched, options, recording, threads, executed, .. } = self;
        let workers = threads.workers().cloned();
        let (workers, poison) = (workers.as_ref(), options.poison);
        let frame = &Prepared { gpu, plan, realized, caches, timing, workers, touched, poison };
        let arenas = &*arenas;
        let all = 0..plan.steps().len() as u32;
        let commands = match to {
            Destination::Own => {
                let split = threads.record(frame, arenas, passes, recording, elsewhere);
                let commands = split.unwrap_or_else(|| record_part(frame, arenas, passes, all, recording, None));
                threads.end_frame(recording);
                commands
            }
            Destination::Stepwise(each) => record_part(frame, arenas, passes, all, recording, Some(each)),
            Destination::Encoder(_) if arenas.current().is_some() => Err(ExecuteError::SharedMemory),
            Destination::Encoder(encoder) => {
                record_into(frame, passes, recording, encoder).map(|()| CommandList::default())
            }
        };
        let commands = commands.map(|buffers| FrameCommands::new(buffers, arenas.submits_separately(gpu)));
        *executed = recording.executed;
        executed.memoryless = realized.memoryless();
        let commands = commands?;
        executed.culled = plan.graph().passes().len() as u32 - executed.passes;
        Ok(commands)
    }

    /// Returns how much memory the frame needs.
    fn memory_request(&self, plan: &Plan) -> MemoryRequest {
        let (memory, bytes) = (plan.memory(), |r: ResourceId| plan.resources()[r.index()].bytes);
        let largest = plan.graph().resource_ids().max_by_key(|r| bytes(*r));
        MemoryRequest {
            bytes: memory.bytes.saturating_add(memory.own_bytes),
            largest: largest.map(|r| (Named::resource(plan, r), bytes(r))),
            adapter: self.gpu.info().clone(),
        }
    }
}

/// Checks that a plan belongs to a frame.
fn check<W: ?Sized>(plan: &Plan, frame: &Frame<W>) -> Result<(), ExecuteError> {
    if frame.graph().same_as(plan.graph()) { Ok(()) } else { Err(ExecuteError::OtherPlan) }
}

/// Returns whether the error `said` of recording is a consequence of the device's `error`. An example is a view of a
/// texture that could not be allocated. Otherwise the recorder's error is closer to the cause.
fn is_consequence(said: &ExecuteError, error: &DeviceError) -> bool {
    let of_a_view =
        matches!(said, ExecuteError::Device(_) | ExecuteError::Record { error: RecordError::View { .. }, .. });
    of_a_view || matches!(error, DeviceError::OutOfMemory { .. } | DeviceError::Lost { .. })
}

#[cfg(test)]
mod tests;
