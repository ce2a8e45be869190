//! Why light could not be made of an environment.

use crate::error::PassError;
use framegraph::{CompileErrors, DeclareError};
use framegraph_scene::SceneError;
use framegraph_wgpu::{DeviceError, ExecuteError, ReadbackError};

/// Why light could not be made of an environment.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum IblError {
    /// A setting is out of range, or the work was interrupted.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A shader is wrong.
    #[error(transparent)]
    Shader(#[from] PassError),
    /// A pass of the work was refused when it was declared.
    #[error(transparent)]
    Declare(#[from] DeclareError),
    /// The graph of a slice of the work does not compile.
    #[error(transparent)]
    Compile(#[from] CompileErrors),
    /// A slice of the work could not be executed.
    #[error(transparent)]
    Execute(ExecuteError),
    /// The device refused, ran out of memory, or was lost.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// What was computed could not be read back for the cache.
    #[error(transparent)]
    Readback(#[from] ReadbackError),
}

/// Why an entry of the cache is of no use. Whoever finds one computes it anew.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(super) enum EntryError {
    /// The file or its payload has fewer bytes than it should.
    #[error("it is cut short")]
    CutShort,
    /// The payload has more bytes than it should.
    #[error("it goes on after its end")]
    TrailingBytes,
    /// The file does not begin as entries do.
    #[error("it is no entry of this cache")]
    Magic,
    /// The file has another layout.
    #[error("it is of another version")]
    Version,
    /// Some bytes changed after it was written.
    #[error("it is damaged: its checksum is wrong")]
    Checksum,
    /// The file was renamed or copied: its key or kind is that of another entry.
    #[error("it is another entry under a wrong name")]
    Name,
    /// The payload has another size or format than what was asked for.
    #[error("it holds a cube or table of another size or format")]
    Shape,
    /// The number of bands of spherical harmonics is none that there is.
    #[error("it holds {0} bands of spherical harmonics, which must be 2, 3 or 5")]
    Bands(u32),
    /// A number is infinite or NaN.
    #[error("it holds numbers that are not finite")]
    NotFinite,
}
