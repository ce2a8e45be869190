//! Why a scene did not reach the GPU.

use framegraph_scene::SceneError;
use framegraph_wgpu::DeviceError;

/// Why a scene did not reach the GPU.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum UploadError {
    /// Something of it exceeds a limit of the device, or the upload was interrupted.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The device refused, ran out of memory, or was lost.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// What is written over a material is drawn by another shader than it.
    #[error(
        "material {number} `{name}` has other lobes than the one that was uploaded, or there was none; upload the scene anew"
    )]
    OtherMaterial {
        /// Its name.
        name: String,
        /// Its number.
        number: usize,
    },
}

impl std::fmt::Debug for UploadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
