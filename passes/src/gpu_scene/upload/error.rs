//! Errors of uploading a scene.

use framegraph_scene::{ImageFormat, SceneError};
use framegraph_wgpu::DeviceError;

/// Error of uploading a scene.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum UploadError {
    /// The scene exceeds a limit of the device, or the upload was interrupted.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The device failed, ran out of memory, or was lost.
    #[error(transparent)]
    Device(#[from] DeviceError),
    /// The device cannot sample the block format of an image.
    #[error("{image}: this device does not sample {}; load the scene with the `block_formats` of the device", name_of(*format))]
    Format {
        /// Name of the image.
        image: String,
        /// Its format.
        format: ImageFormat,
    },
    /// What is written over a material is drawn by another shader than it.
    #[error(
        "material {number} `{name}` has other lobes than the one that was uploaded, or there was none; upload the scene anew"
    )]
    OtherMaterial {
        /// Name of the material.
        name: String,
        /// Index of the material.
        number: usize,
    },
}

/// Returns the name of a format in its specification.
fn name_of(format: ImageFormat) -> &'static str {
    match format {
        ImageFormat::Rgba8 => "RGBA8",
        ImageFormat::Bc7 => "BC7",
        ImageFormat::Etc2Rgba8 => "ETC2 RGBA8",
        ImageFormat::Astc4x4 => "ASTC 4×4",
    }
}

impl std::fmt::Debug for UploadError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}
