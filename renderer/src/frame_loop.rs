//! A frame, its plan and its executor in one value, for programs that declare the frame every time.

use crate::device::gpu::Gpu;
use crate::execute::commands::FrameCommands;
use crate::execute::error::ExecuteError;
use crate::execute::executor::{Executor, ExecutorOptions, WarmUpProgress};
use crate::frame::Frame;
use crate::frames_in_flight::FramesInFlight;
use crate::placed::not_placed::NotPlaced;
use crate::resources::imports::Imports;
use framegraph::{Alias, CompileErrors, DeclareError, Options, Plan, Scratch, Warning};
use std::fmt;
use wgpu::{CommandEncoder, SubmissionIndex};

/// Declares, compiles and executes one frame after the other.
///
/// Owns the frame, its plan, compiler memory, imports and executor. Declare the whole frame in each call: this takes
/// microseconds and allocates nothing after the first frames. An unchanged frame is not compiled again, so the caller
/// need not track changes.
///
/// ```
/// use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, TextureDesc};
/// use framegraph_wgpu::{FrameLoop, Gpu, read_texture};
///
/// let gpu = Gpu::noop()?;
/// let mut frames = FrameLoop::new(&gpu);
/// for size in [[64, 36], [0, 0], [80, 45]] {
///     let output = frames.run(size, &(), |frame, _imports| {
///         let sky = frame.graph_mut().texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
///         let sky = frame.add_fn("clear", |pass| pass.color(sky, Intent::Clear(ClearValue::BLACK)), |_, _, _| Ok(()))?;
///         frame.graph_mut().readback(sky)?;
///         Ok::<_, DeclareError>(sky)
///     })?;
///     let Some(output) = output else { continue }; // A minimized window has no texels.
///     let texture = frames.executor().texture(frames.plan(), output.io).ok_or("no picture")?;
///     assert_eq!(read_texture(&gpu, texture)?.texels, size);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct FrameLoop<W: ?Sized = ()> {
    frame: Frame<W>,
    /// Frame for worlds of other types, between two uses ([`FrameLoop::run_for`]).
    other: Option<Frame<()>>,
    plan: Plan,
    scratch: Scratch,
    options: Options,
    imports: Imports,
    executor: Executor,
    flight: FramesInFlight,
    /// Compilation of the last frame if `frame` declared it and it was executed or recorded; otherwise 0.
    executed: u64,
}

/// Result of an executed frame.
#[derive(Clone, Debug)]
pub struct FrameOutput<T> {
    /// Value returned by the closure that declared the frame.
    pub io: T,
    /// Index of the submission that contains the frame's commands.
    pub submission: SubmissionIndex,
    /// Reason why [`Alias::Heap`] was requested but not used; textures then share memory by equal shape. `None` if heap
    /// aliasing is active or was not requested.
    pub not_placed: Option<NotPlaced>,
}

/// Error of a frame that was not executed. The next frame starts clean.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum FrameError<E = DeclareError> {
    /// The declaration failed.
    #[error(transparent)]
    Declare(E),
    /// The declared graph does not compile.
    #[error(transparent)]
    Compile(#[from] CompileErrors),
    /// The plan executes nothing, usually because an export is missing.
    #[error("the frame does nothing: {}", .0.sentence())]
    Idle(Warning),
    /// The plan could not be executed.
    #[error(transparent)]
    Execute(#[from] ExecuteError),
}

impl<E> fmt::Debug for FrameError<E>
where
    Self: fmt::Display,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl<W: ?Sized> FrameLoop<W> {
    /// Creates a frame loop with the default compiler and executor options.
    pub fn new(gpu: &Gpu) -> Self {
        Self::with(gpu, Options::default(), ExecutorOptions::default())
    }

    /// Creates a frame loop with the given options. `options.frame` is overwritten with the size of each frame.
    pub fn with(gpu: &Gpu, options: Options, executor: ExecutorOptions) -> Self {
        Self {
            frame: Frame::new(),
            other: None,
            plan: Plan::new(),
            scratch: Scratch::new(),
            options,
            imports: Imports::new(),
            executor: Executor::with(gpu, executor),
            flight: FramesInFlight::new(gpu),
            executed: 0,
        }
    }

    /// Declares, compiles and executes a frame of `size` texels.
    ///
    /// `declare` receives the empty frame and the imports to bind. If width or height is 0, the frame is skipped and
    /// `None` is returned. Blocks while the maximum number of frames is queued ([`FrameLoop::frames_in_flight_mut`]).
    ///
    /// # Errors
    /// Fails with [`FrameError`] if the frame cannot be declared, compiled or executed. Nothing of the frame is
    /// submitted in that case.
    pub fn run<T, E>(
        &mut self,
        size: [u32; 2],
        world: &W,
        declare: impl FnOnce(&mut Frame<W>, &mut Imports) -> Result<T, E>,
    ) -> Result<Option<FrameOutput<T>>, FrameError<E>> {
        let queue = self.executor.gpu().queue.clone();
        self.run_with(size, world, declare, |commands| commands.submit(&queue, [], []))
    }

    /// Runs a frame like [`FrameLoop::run`], but lets `submit` submit the commands ([`Executor::execute_with`]).
    ///
    /// # Errors
    /// Fails like [`FrameLoop::run`].
    pub fn run_with<T, E>(
        &mut self,
        size: [u32; 2],
        world: &W,
        declare: impl FnOnce(&mut Frame<W>, &mut Imports) -> Result<T, E>,
        submit: impl FnOnce(FrameCommands) -> SubmissionIndex,
    ) -> Result<Option<FrameOutput<T>>, FrameError<E>> {
        let Self { frame, plan, scratch, options, imports, executor, flight, executed, .. } = self;
        let before = std::mem::take(executed);
        let mut parts = Parts { plan, scratch, options, imports, executor, flight };
        let output = parts.run(frame, size, world, declare, submit)?;
        // A skipped frame leaves the previous one in place.
        *executed = if output.is_some() { self.plan.compilation() } else { before };
        Ok(output)
    }

    /// Runs a frame like [`FrameLoop::run`], with a world of another type that may live for this call only. Use it for
    /// worlds that borrow data which changes between frames.
    ///
    /// These frames have histories of their own, and [`FrameLoop::frame`] does not return them.
    ///
    /// ```
    /// use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, TextureDesc};
    /// use framegraph_wgpu::{Frame, FrameLoop, Gpu};
    ///
    /// struct World<'a> {
    ///     names: &'a [String],
    /// }
    ///
    /// let mut frames = FrameLoop::<()>::new(&Gpu::noop()?);
    /// let mut names = Vec::new();
    /// for number in 0..3 {
    ///     names.push(format!("object {number}"));
    ///     let world = World { names: &names };
    ///     frames.run_for([64, 36], &world, |frame: &mut Frame<World<'_>>, _| {
    ///         let sky = frame.graph_mut().texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
    ///         let clear = Intent::Clear(ClearValue::BLACK);
    ///         let sky = frame.add_fn("clear", |pass| pass.color(sky, clear), |_, world: &World<'_>, cx| {
    ///             cx.render_pass()?.insert_debug_marker(&world.names[0]);
    ///             Ok(())
    ///         })?;
    ///         frame.graph_mut().readback(sky)?;
    ///         Ok::<_, DeclareError>(())
    ///     })?;
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Fails like [`FrameLoop::run`].
    pub fn run_for<V: ?Sized, T, E>(
        &mut self,
        size: [u32; 2],
        world: &V,
        declare: impl FnOnce(&mut Frame<V>, &mut Imports) -> Result<T, E>,
    ) -> Result<Option<FrameOutput<T>>, FrameError<E>> {
        let Self { other, plan, scratch, options, imports, executor, flight, executed, .. } = self;
        *executed = 0;
        let queue = executor.gpu().queue.clone();
        let mut frame = other.take().unwrap_or_default().for_world();
        let mut parts = Parts { plan, scratch, options, imports, executor, flight };
        let output = parts.run(&mut frame, size, world, declare, |commands| commands.submit(&queue, [], []));
        *other = Some(frame.for_world());
        output
    }

    /// Sets the threads to record on ([`Executor::record_on`]), for worlds that threads can share. `None` records on
    /// the calling thread only.
    #[cfg(feature = "threads")]
    pub fn record_on(&mut self, workers: Option<crate::workers::Workers>)
    where
        W: Sync,
    {
        self.frame.allow_threads();
        self.executor.record_on(workers);
    }

    /// Runs a frame like [`FrameLoop::run`], but returns its commands instead of submitting them.
    ///
    /// The caller submits the commands and then calls [`FrameLoop::submitted`]. [`Executor::record`] lists the
    /// restrictions that apply until then.
    ///
    /// # Errors
    /// Fails like [`FrameLoop::run`].
    pub fn record<T, E>(
        &mut self,
        size: [u32; 2],
        world: &W,
        declare: impl FnOnce(&mut Frame<W>, &mut Imports) -> Result<T, E>,
    ) -> Result<Option<(T, FrameCommands)>, FrameError<E>> {
        if size.contains(&0) {
            return Ok(None);
        }
        self.flight.begin().map_err(ExecuteError::Device)?;
        let Some(io) = self.declare(size, declare)? else { return Ok(None) };
        let commands = self.executor.record(&self.plan, &self.frame, world, &self.imports)?;
        self.executed = self.plan.compilation();
        Ok(Some((io, commands)))
    }

    /// Runs a frame like [`FrameLoop::run`], but records its commands into the caller's encoder
    /// ([`Executor::record_into`]). The caller submits it and then calls [`FrameLoop::submitted`].
    ///
    /// # Errors
    /// Fails like [`FrameLoop::run`]. After an error, the encoder must be dropped.
    pub fn record_into<T, E>(
        &mut self,
        size: [u32; 2],
        world: &W,
        encoder: &mut CommandEncoder,
        declare: impl FnOnce(&mut Frame<W>, &mut Imports) -> Result<T, E>,
    ) -> Result<Option<T>, FrameError<E>> {
        if size.contains(&0) {
            return Ok(None);
        }
        self.flight.begin().map_err(ExecuteError::Device)?;
        let Some(io) = self.declare(size, declare)? else { return Ok(None) };
        self.executor.record_into(&self.plan, &self.frame, world, &self.imports, encoder)?;
        self.executed = self.plan.compilation();
        Ok(Some(io))
    }

    /// Reports that the commands of [`FrameLoop::record`] or [`FrameLoop::record_into`] were submitted with the index
    /// `submission`.
    pub fn submitted(&mut self, submission: SubmissionIndex) {
        self.executor.submitted();
        self.flight.submitted(submission);
    }

    /// Declares and compiles a frame without executing it, the first half of [`FrameLoop::run`].
    ///
    /// # Errors
    /// Fails like [`FrameLoop::run`]. A plan with warnings is an error ([`FrameError::Idle`]), for example if an export
    /// was forgotten.
    pub fn declare<T, E>(
        &mut self,
        size: [u32; 2],
        declare: impl FnOnce(&mut Frame<W>, &mut Imports) -> Result<T, E>,
    ) -> Result<Option<T>, FrameError<E>> {
        let Self { frame, plan, scratch, options, imports, executor, flight, executed, .. } = self;
        *executed = 0;
        Parts { plan, scratch, options, imports, executor, flight }.declare(frame, size, declare)
    }

    /// Creates the textures and pipelines of the last declared frame ahead of its execution ([`Executor::warm_up`]).
    ///
    /// # Errors
    /// Fails like [`Executor::execute`].
    pub fn warm_up(&mut self, world: &W, progress: &mut dyn FnMut(WarmUpProgress<'_>)) -> Result<(), ExecuteError> {
        self.executor.warm_up(&self.plan, &self.frame, world, &self.imports, progress)
    }

    /// Returns the frame as it was last declared.
    pub fn frame(&self) -> &Frame<W> {
        &self.frame
    }

    /// Returns the plan that the last declared frame was compiled to.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Returns the imports bound when the frame was last declared.
    pub fn imports(&self) -> &Imports {
        &self.imports
    }

    /// Returns the compiler options for changing them. Changes take effect in the next frame.
    pub fn options_mut(&mut self) -> &mut Options {
        &mut self.options
    }

    /// Returns the queue of submitted frames, with the latency of recent frames.
    pub fn frames_in_flight(&self) -> &FramesInFlight {
        &self.flight
    }

    /// Returns the queue of submitted frames mutably, to set its maximum length.
    pub fn frames_in_flight_mut(&mut self) -> &mut FramesInFlight {
        &mut self.flight
    }

    /// Returns `true` if the last frame was declared for this world type, and was executed or recorded.
    #[cfg(feature = "remote")]
    pub(crate) fn has_executed(&self) -> bool {
        self.executed != 0 && self.executed == self.plan.compilation()
    }

    /// Returns the parts of the last frame.
    #[cfg(feature = "remote")]
    pub(crate) fn parts_mut(&mut self) -> (&mut Executor, &Plan, &Frame<W>, &Imports) {
        (&mut self.executor, &self.plan, &self.frame, &self.imports)
    }

    /// Returns the executor of the frames.
    pub fn executor(&self) -> &Executor {
        &self.executor
    }

    /// Returns the executor mutably, to reset histories, trim pools or reload shaders.
    pub fn executor_mut(&mut self) -> &mut Executor {
        &mut self.executor
    }
}

/// Parts of a frame loop that do not depend on the type of the world.
struct Parts<'l> {
    plan: &'l mut Plan,
    scratch: &'l mut Scratch,
    options: &'l mut Options,
    imports: &'l mut Imports,
    executor: &'l mut Executor,
    flight: &'l mut FramesInFlight,
}

impl Parts<'_> {
    fn declare<W: ?Sized, T, E>(
        &mut self,
        frame: &mut Frame<W>,
        size: [u32; 2],
        declare: impl FnOnce(&mut Frame<W>, &mut Imports) -> Result<T, E>,
    ) -> Result<Option<T>, FrameError<E>> {
        if size.contains(&0) {
            return Ok(None);
        }
        frame.reset();
        self.imports.clear();
        let io = declare(frame, self.imports).map_err(FrameError::Declare)?;
        self.options.frame = size;
        self.executor.compile(frame.graph(), self.options, self.scratch, self.plan)?;
        self.plan.warnings().next().map_or(Ok(Some(io)), |warning| Err(FrameError::Idle(warning)))
    }

    fn run<W: ?Sized, T, E>(
        &mut self,
        frame: &mut Frame<W>,
        size: [u32; 2],
        world: &W,
        declare: impl FnOnce(&mut Frame<W>, &mut Imports) -> Result<T, E>,
        submit: impl FnOnce(FrameCommands) -> SubmissionIndex,
    ) -> Result<Option<FrameOutput<T>>, FrameError<E>> {
        if size.contains(&0) {
            return Ok(None);
        }
        self.flight.begin().map_err(ExecuteError::Device)?;
        let Some(io) = self.declare(frame, size, declare)? else { return Ok(None) };
        let submission = self.executor.execute_with(self.plan, frame, world, self.imports, submit)?;
        self.flight.submitted(submission.clone());
        let requested = self.options.alias == Alias::Heap;
        let not_placed = self.executor.not_placed().filter(|_| requested).cloned();
        Ok(Some(FrameOutput { io, submission, not_placed }))
    }
}
