//! Everything that stays from frame to frame, in one value: declare and go.

use crate::device::gpu::Gpu;
use crate::execute::commands::FrameCommands;
use crate::execute::error::ExecuteError;
use crate::execute::executor::{Executor, ExecutorOptions, WarmUp};
use crate::frame::Frame;
use crate::frames_in_flight::FramesInFlight;
use crate::placed::not_placed::NotPlaced;
use crate::resources::imports::Imports;
use framegraph::{Alias, CompileErrors, DeclareError, Options, Plan, Scratch, Warning};
use std::fmt;
use wgpu::SubmissionIndex;

/// A frame that is declared anew each time, with its plan, the memory to compile it, its imports and its executor.
///
/// Declaring costs microseconds and allocates nothing once warm, and a frame that is declared as before is not compiled
/// again; so nothing has to be remembered about what changed.
///
/// ```
/// use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, TextureDesc};
/// use framegraph_wgpu::{FrameLoop, Gpu, read_texture};
///
/// let gpu = Gpu::noop()?;
/// let mut frames = FrameLoop::new(&gpu);
/// for size in [[64, 36], [0, 0], [80, 45]] {
///     let ran = frames.run(size, &(), |frame, _imports| {
///         let sky = frame.graph_mut().texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
///         let sky = frame.add_fn("clear", |pass| pass.color(sky, Intent::Clear(ClearValue::BLACK)), |_, _, _| Ok(()))?;
///         frame.graph_mut().readback(sky)?;
///         Ok::<_, DeclareError>(sky)
///     })?;
///     let Some(ran) = ran else { continue }; // A minimized window has no texels.
///     let texture = frames.executor().texture(frames.plan(), ran.io).ok_or("no picture")?;
///     assert_eq!(read_texture(&gpu, texture)?.texels, size);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct FrameLoop<W: ?Sized + 'static = ()> {
    frame: Frame<W>,
    plan: Plan,
    scratch: Scratch,
    options: Options,
    imports: Imports,
    executor: Executor,
    flight: FramesInFlight,
}

/// A frame that was executed.
#[derive(Clone, Debug)]
pub struct Ran<T> {
    /// What declaring it returned.
    pub io: T,
    /// The submission of its commands.
    pub submission: SubmissionIndex,
    /// Why textures that were asked to share one block of memory ([`Alias::Heap`]) share by shape instead; none where they lie in one,
    /// or were not asked to.
    pub not_placed: Option<NotPlaced>,
}

/// A frame was not executed; the next one starts clean.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum FrameError<E = DeclareError> {
    /// It could not be declared.
    #[error(transparent)]
    Declare(E),
    /// It was declared and cannot be compiled.
    #[error(transparent)]
    Compile(#[from] CompileErrors),
    /// It was compiled, and the plan does nothing of what was declared.
    #[error("the frame does nothing: {}", .0.sentence())]
    Idle(Warning),
    /// It was compiled and could not be executed.
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

impl<W: ?Sized + Sync + 'static> FrameLoop<W> {
    /// With the default options of compiler and executor.
    pub fn new(gpu: &Gpu) -> Self {
        Self::with(gpu, Options::default(), ExecutorOptions::default())
    }

    /// With these options; the frame's size in `options` is that of each frame.
    pub fn with(gpu: &Gpu, options: Options, executor: ExecutorOptions) -> Self {
        Self {
            frame: Frame::new(),
            plan: Plan::new(),
            scratch: Scratch::new(),
            options,
            imports: Imports::new(),
            executor: Executor::with(gpu, executor),
            flight: FramesInFlight::new(gpu),
        }
    }

    /// Declares, compiles and executes a frame of `size` texels: `declare` is given the empty frame, and binds what stands
    /// for its imports. A size of 0 in either direction skips the frame. Before, it waits while as many frames are queued as
    /// may be ([`FrameLoop::frames_in_flight_mut`]).
    ///
    /// # Errors
    /// [`FrameError`]. Nothing of the frame reached the GPU then.
    pub fn run<T, E>(
        &mut self,
        size: [u32; 2],
        world: &W,
        declare: impl FnOnce(&mut Frame<W>, &mut Imports) -> Result<T, E>,
    ) -> Result<Option<Ran<T>>, FrameError<E>> {
        let queue = self.executor.gpu().queue.clone();
        self.run_with(size, world, declare, |commands| commands.submit(&queue, [], []))
    }

    /// As [`FrameLoop::run`], submitted by the caller ([`Executor::execute_with`]).
    ///
    /// # Errors
    /// As [`FrameLoop::run`].
    pub fn run_with<T, E>(
        &mut self,
        size: [u32; 2],
        world: &W,
        declare: impl FnOnce(&mut Frame<W>, &mut Imports) -> Result<T, E>,
        submit: impl FnOnce(FrameCommands) -> SubmissionIndex,
    ) -> Result<Option<Ran<T>>, FrameError<E>> {
        if size.contains(&0) {
            return Ok(None);
        }
        self.flight.begin().map_err(ExecuteError::Device)?;
        let Some(io) = self.declare(size, declare)? else { return Ok(None) };
        let submission = self.executor.execute_with(&self.plan, &self.frame, world, &self.imports, submit)?;
        self.flight.submitted(submission.clone());
        let asked = self.options.alias == Alias::Heap;
        let not_placed = self.executor.not_placed().filter(|_| asked).cloned();
        Ok(Some(Ran { io, submission, not_placed }))
    }

    /// As [`FrameLoop::run`], with the commands handed out instead of submitted: [`Executor::record`] says what holds until
    /// [`FrameLoop::submitted`] is told of their submission.
    ///
    /// # Errors
    /// As [`FrameLoop::run`].
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
        Ok(Some((io, self.executor.record(&self.plan, &self.frame, world, &self.imports)?)))
    }

    /// What [`FrameLoop::record`] handed out last was submitted, with that index.
    pub fn submitted(&mut self, submission: SubmissionIndex) {
        self.executor.submitted();
        self.flight.submitted(submission);
    }

    /// The first half of [`FrameLoop::run`]: declares and compiles, and executes nothing. A plan that does nothing of what was
    /// declared, since an export was forgotten, is an error here: nobody else looks at it.
    ///
    /// # Errors
    /// As [`FrameLoop::run`].
    pub fn declare<T, E>(
        &mut self,
        size: [u32; 2],
        declare: impl FnOnce(&mut Frame<W>, &mut Imports) -> Result<T, E>,
    ) -> Result<Option<T>, FrameError<E>> {
        if size.contains(&0) {
            return Ok(None);
        }
        self.frame.reset();
        self.imports.clear();
        let io = declare(&mut self.frame, &mut self.imports).map_err(FrameError::Declare)?;
        self.options.frame = size;
        self.executor.compile(self.frame.graph(), &self.options, &mut self.scratch, &mut self.plan)?;
        self.plan.warnings().next().map_or(Ok(Some(io)), |warning| Err(FrameError::Idle(warning)))
    }

    /// Makes what the frame declared last takes, before it is wanted ([`Executor::warm_up`]).
    ///
    /// # Errors
    /// As [`Executor::execute`].
    pub fn warm_up(&mut self, world: &W, progress: &mut dyn FnMut(WarmUp<'_>)) -> Result<(), ExecuteError> {
        self.executor.warm_up(&self.plan, &self.frame, world, &self.imports, progress)
    }

    /// The frame as it was declared last.
    pub fn frame(&self) -> &Frame<W> {
        &self.frame
    }

    /// What the compiler made of it.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// What stood for its imports.
    pub fn imports(&self) -> &Imports {
        &self.imports
    }

    /// How frames are compiled; a change holds from the next one on.
    pub fn options_mut(&mut self) -> &mut Options {
        &mut self.options
    }

    /// The frames that the device is not done with, and how long frames take from their begin until it is.
    pub fn frames_in_flight(&self) -> &FramesInFlight {
        &self.flight
    }

    /// As [`FrameLoop::frames_in_flight`], to set how many there may be.
    pub fn frames_in_flight_mut(&mut self) -> &mut FramesInFlight {
        &mut self.flight
    }

    /// Who executes them.
    pub fn executor(&self) -> &Executor {
        &self.executor
    }

    /// As [`FrameLoop::executor`], to reset histories, trim pools, reload shaders.
    pub fn executor_mut(&mut self) -> &mut Executor {
        &mut self.executor
    }
}
