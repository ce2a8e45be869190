//! A frame: declared passes together with their recorders.
//!
//! [`Frame`] pairs every pass of a [`framegraph::Graph`] with the recorder that writes its commands. Declare a frame,
//! compile its graph and execute it. Then either declare it again ([`Frame::reset`]), or execute it again while nothing
//! changes.
//!
//! Per-frame data such as the camera, draw lists and the scene on the GPU is not stored in the frame. The caller passes
//! it to `execute` as a value of type `W`, the *world*, and recorders receive a reference to it. Passes therefore hold
//! only handles and settings, and borrow nothing. The world may borrow ([`Frame::for_world`]).

use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::frame_key::FrameKey;
use crate::record::Record;
use crate::recorders::{ClosureRecorder, PassRecorder, Recorders};
use crate::workers::{ShareWorld, share_world};
use framegraph::{DeclareError, Graph, PassBuilder, PassId};

/// A declared graph with a recorder for each pass. See the [module documentation](self).
///
/// ```
/// use framegraph::{ClearValue, Extent, Format, Intent, TextureDesc};
/// use framegraph_wgpu::Frame;
///
/// /// Data that recorders receive when the frame is executed.
/// struct World {
///     stencil: u32,
/// }
///
/// let mut frame = Frame::<World>::new();
/// let mask = frame.scope("outline", |frame| {
///     frame.add_fn(
///         "mask",
///         |pass| {
///             let mask = pass.texture("mask", TextureDesc::new(Extent::FRAME, Format::Depth24PlusStencil8));
///             pass.depth(mask, Intent::Clear(ClearValue::DepthStencil(0.0, 0)))
///         },
///         |_mask, world, cx| {
///             cx.render_pass()?.set_stencil_reference(world.stencil);
///             Ok(())
///         },
///     )
/// })?;
/// frame.graph_mut().export(mask)?;
/// assert!(frame.graph().find_pass("outline/mask").is_some());
/// # Ok::<(), framegraph::DeclareError>(())
/// ```
pub struct Frame<W: ?Sized = ()> {
    graph: Graph,
    recorders: Recorders<W>,
    key: FrameKey,
    /// Gives worker threads access to the world; `None` if the frame is recorded on one thread.
    share: Option<ShareWorld<W>>,
}

impl<W: ?Sized> Default for Frame<W> {
    fn default() -> Self {
        Self::from_graph(Graph::new())
    }
}

impl<W: ?Sized> Frame<W> {
    /// Creates an empty frame.
    pub fn new() -> Self {
        Self::default()
    }

    /// Creates a frame from a graph that was declared elsewhere, for example read from a file. Its passes have no
    /// recorders yet.
    pub fn from_graph(graph: Graph) -> Self {
        Self { graph, recorders: Recorders::default(), key: FrameKey::new(), share: None }
    }

    pub(crate) fn key(&self) -> &FrameKey {
        &self.key
    }

    pub(crate) fn share(&self) -> Option<ShareWorld<W>> {
        self.share
    }

    /// Lets executors record this frame on their worker threads, if they have any. Without this call, the frame is
    /// recorded on the calling thread, and the world need not be `Sync`.
    pub fn allow_threads(&mut self)
    where
        W: Sync,
    {
        self.share = Some(share_world);
    }

    /// Resets the frame for a world of another type, and keeps its memory and histories.
    ///
    /// A world that borrows has a lifetime in its type, so it cannot outlive the data that it borrows. Keep a
    /// `Frame<()>` between frames, and convert it for each world:
    ///
    /// ```
    /// use framegraph::{ClearValue, Extent, Format, Intent, Options, Plan, Scratch, TextureDesc, recompile};
    /// use framegraph_wgpu::{Executor, Frame, Gpu, Imports};
    ///
    /// struct World<'a> {
    ///     stencil: &'a u32,
    /// }
    ///
    /// let gpu = Gpu::noop()?;
    /// let (mut executor, mut plan, mut scratch) = (Executor::new(&gpu), Plan::new(), Scratch::new());
    /// let (mut kept, mut stencil) = (Frame::new(), 0);
    /// for _ in 0..3 {
    ///     stencil += 1;
    ///     let world = World { stencil: &stencil };
    ///     let mut frame: Frame<World<'_>> = kept.for_world();
    ///     let mask = frame.graph_mut().texture("mask", TextureDesc::new(Extent::FRAME, Format::Depth24PlusStencil8));
    ///     let clear = Intent::Clear(ClearValue::DepthStencil(0.0, 0));
    ///     let mask = frame.add_fn("mask", |pass| pass.depth(mask, clear), |_, world: &World<'_>, cx| {
    ///         cx.render_pass()?.set_stencil_reference(*world.stencil);
    ///         Ok(())
    ///     })?;
    ///     frame.graph_mut().export(mask)?;
    ///     recompile(frame.graph(), &gpu.caps(), &Options::for_frame(8, 8), &mut scratch, &mut plan)?;
    ///     executor.execute(&plan, &frame, &world, &Imports::new())?;
    ///     kept = frame.for_world::<()>();
    /// }
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn for_world<V: ?Sized>(self) -> Frame<V> {
        let Self { mut graph, recorders, key, .. } = self;
        graph.reset();
        Frame { graph, recorders: recorders.for_world(), key, share: None }
    }

    /// Sets or replaces the recorder of a pass.
    pub fn set_recorder<R>(&mut self, pass: PassId, record: R)
    where
        R: Fn(&PassId, &W, &mut Cx<'_>) -> Result<(), RecordError> + Send + Sync + 'static,
    {
        self.recorders.insert(pass, ClosureRecorder { io: pass, record });
    }

    /// Removes all passes and resources but keeps the allocated memory. Handles from before the reset are rejected.
    ///
    /// Histories survive a reset: they are identified by frame and name, and are freed when the frame is dropped.
    pub fn reset(&mut self) {
        self.graph.reset();
        self.recorders.clear();
    }

    /// Declares a pass, stores it for recording, and returns its handles.
    ///
    /// # Errors
    /// Returns the error of the pass's declaration. The frame is unchanged in that case.
    #[track_caller]
    pub fn add<P>(&mut self, name: &str, pass: P) -> Result<P::Io, DeclareError>
    where
        P: Record<W> + Send + Sync + 'static,
        P::Io: Send + Sync + 'static,
    {
        let io = self.graph.add(name, &pass)?;
        self.insert(PassRecorder { pass, io: io.clone() });
        Ok(io)
    }

    /// Adds a one-off pass made of two closures. `record` receives the handles that `declare` returned.
    ///
    /// # Errors
    /// Returns the error of `declare`. The frame is unchanged in that case.
    #[track_caller]
    pub fn add_fn<Io, R>(
        &mut self,
        name: &str,
        declare: impl FnOnce(&mut PassBuilder<'_>) -> Result<Io, DeclareError>,
        record: R,
    ) -> Result<Io, DeclareError>
    where
        Io: Clone + Send + Sync + 'static,
        R: Fn(&Io, &W, &mut Cx<'_>) -> Result<(), RecordError> + Send + Sync + 'static,
    {
        let io = self.graph.add_fn(name, declare)?;
        self.insert(ClosureRecorder { io: io.clone(), record });
        Ok(io)
    }

    /// Runs `body` with `name/` prepended to every name declared in it. Use it to group the passes of one effect;
    /// scopes nest.
    pub fn scope<T>(&mut self, name: &str, body: impl FnOnce(&mut Self) -> T) -> T {
        let scope = self.graph.open_scope(name);
        let out = body(self);
        self.graph.close_scope(scope);
        out
    }

    /// Returns the declared graph, the input of the compiler.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// Returns the graph mutably, to declare resources, imports, exports and histories.
    ///
    /// Add passes with [`Frame::add`] instead: a pass added to the graph directly has no recorder, and executing it is
    /// an error.
    pub fn graph_mut(&mut self) -> &mut Graph {
        &mut self.graph
    }

    pub(crate) fn recorders(&self) -> &Recorders<W> {
        &self.recorders
    }

    fn insert<T: crate::recorders::Recorder<W>>(&mut self, recorder: T) {
        // The pass that was just declared is the last one.
        if let Some(pass) = self.graph.pass_ids().next_back() {
            self.recorders.insert(pass, recorder);
        }
    }

    /// Returns whether the pass has a recorder.
    pub fn has_recorder(&self, pass: PassId) -> bool {
        self.recorders.has(pass)
    }
}

/// Graph files can be declared into a frame as into a graph. Passes from a file have no recorder; add one with
/// [`Frame::set_recorder`]. File plugins written for frames add their recorders themselves ([`Frame::add`]).
#[cfg(feature = "files")]
impl<W: ?Sized> framegraph::file::Host for Frame<W> {
    fn graph(&mut self) -> &mut Graph {
        &mut self.graph
    }
}

impl<W: ?Sized> std::fmt::Debug for Frame<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Frame").field("graph", &self.graph).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use framegraph::{ClearValue, Extent, Format, Intent, Pass, Texture, TextureDesc};

    #[derive(Clone, Copy)]
    struct Fill(u8);

    impl Pass for Fill {
        type Io = Texture;
        fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
            if self.0 == 0 {
                return Err(pass.error("zero", "ask for more"));
            }
            let color = pass.texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
            pass.color(color, Intent::Clear(ClearValue::BLACK))
        }
    }

    impl<W: ?Sized> Record<W> for Fill {
        fn record(&self, _: &Texture, _: &W, _: &mut Cx<'_>) -> Result<(), RecordError> {
            Ok(())
        }
    }

    #[test]
    fn every_added_pass_has_a_recorder_and_a_refused_one_leaves_none() -> Result<(), DeclareError> {
        let mut frame = Frame::<str>::new();
        for _ in 0..2 {
            frame.reset();
            frame.add("a", Fill(1))?;
            assert!(frame.add("b", Fill(0)).is_err());
            let color = frame.scope("effect", |frame| frame.add("c", Fill(2)))?;
            frame.add_fn("d", |p| p.sampled(color), |_, _, _| Ok(()))?;
            frame.graph_mut().add("e", &Fill(3))?;
            let names: Vec<_> = frame.graph().pass_ids().map(|p| frame.graph().pass_name(p).to_owned()).collect();
            assert_eq!(names, ["a", "effect/c", "d", "e"]);
            let has: Vec<_> = frame.graph().pass_ids().map(|p| frame.has_recorder(p)).collect();
            assert_eq!(has, [true, true, true, false]);
        }
        Ok(())
    }
}
