//! What an author of passes implements so that a pass can be executed.

use crate::execute::cx::Cx;
use crate::execute::epilogue::Epilogue;
use crate::execute::error::RecordError;
use framegraph::Pass;

/// A pass that can be executed: it declares (see [`Pass`]) and records.
///
/// `W` is what the pass needs of the world: a type of the application's, or a generic that says what it must offer
/// (`impl<W: AsRef<Camera>> Record<W> for Sky`). A pass that needs nothing implements it for every `W`.
///
/// Recorders run in the order of the plan, but are not to count on it: they may read the world and write commands, and
/// nothing else.
pub trait Record<W: ?Sized = ()>: Pass {
    /// Writes the commands of the pass into the step that is open in `cx`; `io` is what [`Pass::declare`] returned.
    ///
    /// # Errors
    /// What `cx` refuses (a handle of another graph, a shader that does not compile), or a reason of the pass's own
    /// ([`RecordError::custom`]). The frame is given up then and nothing of it reaches the GPU.
    fn record(&self, io: &Self::Io, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError>;

    /// What the pass does to a color, for the shader that makes the color: asked instead of [`Record::record`] where the
    /// plan inlines the pass. Only point-wise passes ([`PassBuilder::pointwise`](framegraph::PassBuilder::pointwise)) are ever asked; nothing is to be drawn.
    /// By default there is none, and a frame whose plan asks for one fails with [`RecordError::NoEpilogue`].
    ///
    /// # Errors
    /// As [`Record::record`].
    fn epilogue(&self, _io: &Self::Io, _world: &W, _cx: &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError> {
        Ok(None)
    }
}
