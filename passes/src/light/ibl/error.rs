//! Why light could not be made of an environment.

use crate::error::PassError;
use framegraph::{CompileErrors, DeclareError};
use framegraph_scene::SceneError;
use framegraph_wgpu::{DeviceError, ExecuteError, ReadbackError};

/// Why light could not be made of an environment.
#[derive(thiserror::Error)]
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

impl std::fmt::Debug for IblError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
