//! The trait that makes a pass executable.

use crate::execute::cx::Cx;
use crate::execute::epilogue::Epilogue;
use crate::execute::error::RecordError;
use framegraph::Pass;

/// A pass that can be executed: it declares its accesses (see [`Pass`]) and records its commands.
///
/// `W` is the type of the world, the per-frame data that the application passes to
/// [`Executor::execute`](crate::Executor::execute). Use a concrete type, or a bound that says what the pass needs
/// (`impl<W: AsRef<Camera>> Record<W> for Sky`). A pass that needs no data implements the trait for every `W`.
///
/// Recorders run in the order of the plan, or on several threads at once. They must have no side effects other than
/// writing commands.
///
/// ```
/// use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc};
/// use framegraph_wgpu::{Cx, Frame, Record, RecordError};
///
/// /// World of the application.
/// struct World {
///     viewport: [f32; 4],
/// }
///
/// /// Clears a texture and sets the viewport.
/// struct Clear;
///
/// impl Pass for Clear {
///     type Io = Texture;
///     fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
///         let color = pass.texture("color", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
///         pass.color(color, Intent::Clear(ClearValue::BLACK))
///     }
/// }
///
/// impl Record<World> for Clear {
///     fn record(&self, _color: &Texture, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
///         let [x, y, width, height] = world.viewport;
///         cx.render_pass()?.set_viewport(x, y, width, height, 0.0, 1.0);
///         Ok(())
///     }
/// }
///
/// let mut frame = Frame::<World>::new();
/// let color = frame.add("clear", Clear)?;
/// frame.graph_mut().export(color)?;
/// # Ok::<(), DeclareError>(())
/// ```
pub trait Record<W: ?Sized = ()>: Pass {
    /// Records the commands of the pass into the current step of `cx`. `io` is the value that [`Pass::declare`]
    /// returned.
    ///
    /// # Errors
    /// Returns an error of `cx`, for example if a shader does not compile, or the pass's own error
    /// ([`RecordError::custom`]). The frame is then abandoned, and nothing of it is submitted.
    fn record(&self, io: &Self::Io, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError>;

    /// Returns the pass as an epilogue: code that runs at the end of the fragment shader that produces its input color.
    ///
    /// Called instead of [`Record::record`] where the plan inlines the pass. This happens only for point-wise passes
    /// ([`PassBuilder::pointwise`](framegraph::PassBuilder::pointwise)). The implementation must not draw. The default
    /// returns `None`, which fails the frame with [`RecordError::NoEpilogue`] if the pass is inlined.
    ///
    /// # Errors
    /// Fails like [`Record::record`].
    fn epilogue(&self, _io: &Self::Io, _world: &W, _cx: &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError> {
        Ok(None)
    }
}
