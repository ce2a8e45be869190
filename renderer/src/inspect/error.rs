//! Why a texture could not be inspected.

use crate::device::readback::ReadbackError;
use crate::execute::error::ExecuteError;
use framegraph::{CompileError, DeclareError};

/// A texture cannot be looked at. The frame under study and its plan are as they were.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum InspectError {
    /// No such resource.
    #[error("there is no texture `{name}`; the frame has {known}")]
    NoTexture {
        /// What was asked for.
        name: String,
        /// The textures that there are.
        known: String,
    },
    /// A buffer.
    #[error("`{name}` is a buffer, which has no picture; read it with `read_buffer`")]
    Buffer {
        /// What was asked for.
        name: String,
    },
    /// No such version.
    #[error("`{name}` has no version {asked}; it has {known}")]
    NoVersion {
        /// The texture.
        name: String,
        /// What was asked for.
        asked: String,
        /// The versions that there are.
        known: String,
    },
    /// No such level, layer, plane or sample.
    #[error("`{name}` has no {asked}; it has {known}")]
    NoPart {
        /// The texture.
        name: String,
        /// What was asked for.
        asked: String,
        /// What there is.
        known: String,
    },
    /// An import that the frame writes over what it holds, and of which no copy can be made.
    #[error(
        "looking at `{name}` runs passes that write the import `{import}`, and no copy of that can be made; create it with \
         COPY_SRC"
    )]
    Import {
        /// The texture asked for.
        name: String,
        /// The import.
        import: String,
    },
    /// The inspection's own pass was refused.
    #[error("`{name}` cannot be read: {error}")]
    Declare {
        /// The texture.
        name: String,
        /// Why.
        error: Box<DeclareError>,
    },
    /// The inspected frame does not compile: the part asked for was not written yet, mostly.
    #[error("`{name}` cannot be looked at there: {error}")]
    Compile {
        /// The texture.
        name: String,
        /// Why.
        error: Box<CompileError>,
    },
    /// The inspected frame could not be executed.
    #[error("looking at `{name}`: {error}")]
    Execute {
        /// The texture.
        name: String,
        /// Why.
        error: Box<ExecuteError>,
    },
    /// The result could not be read back.
    #[error("looking at `{name}`: {error}")]
    Readback {
        /// The texture.
        name: String,
        /// Why.
        error: Box<ReadbackError>,
    },
}
