//! Errors of prefiltering an environment.

use crate::error::PassError;
use framegraph::{CompileErrors, DeclareError};
use framegraph_scene::SceneError;
use framegraph_wgpu::{DeviceError, ExecuteError, ReadbackError};

/// Error of prefiltering an environment.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum IblError {
    /// A setting is out of range, or the work was interrupted.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A shader is invalid.
    #[error(transparent)]
    Shader(#[from] PassError),
    /// A pass could not be declared.
    #[error(transparent)]
    Declare(#[from] DeclareError),
    /// The graph of a slice does not compile.
    #[error(transparent)]
    Compile(#[from] CompileErrors),
    /// A slice could not be executed.
    #[error(transparent)]
    Execute(ExecuteError),
    /// The device failed, ran out of memory, or was lost.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// A result could not be read back for the cache.
    #[error(transparent)]
    Readback(#[from] ReadbackError),
}

impl std::fmt::Debug for IblError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
