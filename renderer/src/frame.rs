//! A frame as its author sees it: passes that declare what they touch and record what they draw.
//!
//! [`Frame`] is a [`framegraph::Graph`] with a recorder beside each pass. Declare it, compile its graph, execute it; anew
//! each frame ([`Frame::reset`]) or again and again while nothing changes. What recorders need of the moment (camera, draw
//! lists, scene on the GPU) is no part of it: they are handed the caller's `W`, the *world*, when the frame is executed,
//! so passes hold handles and settings and borrow nothing.

use crate::execute::cx::Cx;
use crate::execute::error::RecordError;
use crate::frame_key::FrameKey;
use crate::record::Record;
use crate::recorders::{ClosureRecorder, PassRecorder, Recorders};
use framegraph::{DeclareError, Graph, PassBuilder, PassId};

/// A declared frame with its recorders. See the [module](self).
///
/// ```
/// use framegraph::{ClearValue, Extent, Format, Intent, TextureDesc};
/// use framegraph_wgpu::Frame;
///
/// /// What recorders are handed when the frame is executed.
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
pub struct Frame<W: ?Sized + 'static = ()> {
    graph: Graph,
    recorders: Recorders<W>,
    key: FrameKey,
}

impl<W: ?Sized + 'static> Default for Frame<W> {
    fn default() -> Self {
        Self::from_graph(Graph::new())
    }
}

impl<W: ?Sized + 'static> Frame<W> {
    /// An empty frame.
    pub fn new() -> Self {
        Self::default()
    }

    /// A frame of a graph that was declared elsewhere: read from a file, say. Its passes have no recorders yet.
    pub fn from_graph(graph: Graph) -> Self {
        Self { graph, recorders: Recorders::default(), key: FrameKey::new() }
    }

    pub(crate) fn key(&self) -> &FrameKey {
        &self.key
    }

    /// Gives a pass its recorder, or another one.
    pub fn set_recorder<R>(&mut self, pass: PassId, record: R)
    where
        R: Fn(&PassId, &W, &mut Cx<'_>) -> Result<(), RecordError> + Send + Sync + 'static,
    {
        self.recorders.insert(pass, ClosureRecorder { io: pass, record });
    }

    /// Forgets everything declared and keeps the memory; handles of before are refused from now on. Histories go on: they
    /// belong to the frame and their names, and end when it is dropped.
    pub fn reset(&mut self) {
        self.graph.reset();
        self.recorders.clear();
    }

    /// Declares a pass, keeps it for recording, and returns its handles.
    ///
    /// # Errors
    /// What its declaration returned; nothing of the pass stays in the frame then.
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

    /// Declares and records a one-off pass with two closures; the second gets what the first returned.
    ///
    /// # Errors
    /// What the first closure returned; nothing of the pass stays in the frame then.
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

    /// Runs `body` with `name/` in front of every name declared in it; effects of several passes nest this way.
    pub fn scope<T>(&mut self, name: &str, body: impl FnOnce(&mut Self) -> T) -> T {
        let scope = self.graph.open_scope(name);
        let out = body(self);
        self.graph.close_scope(scope);
        out
    }

    /// What was declared: the compiler's input.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// For resources, imports, exports and histories. A pass that is added here has no recorder, and executing it is an
    /// error; use [`Frame::add`].
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

    /// Whether the pass can be executed.
    pub fn has_recorder(&self, pass: PassId) -> bool {
        self.recorders.has(pass)
    }
}

/// Files are declared into a frame as into a graph; their plain passes get recorders afterwards ([`Frame::set_recorder`]),
/// and plugins that are written for frames bring their own ([`Frame::add`]).
#[cfg(feature = "files")]
impl<W: ?Sized + 'static> framegraph::file::Host for Frame<W> {
    fn graph(&mut self) -> &mut Graph {
        &mut self.graph
    }
}

impl<W: ?Sized + 'static> std::fmt::Debug for Frame<W> {
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
