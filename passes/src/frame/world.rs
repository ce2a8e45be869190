//! All data that recorders of the standard frame read.
//!
//! Passes ask for parts. An application that keeps the parts elsewhere implements the same `AsRef`s for its own type.

use crate::error::PassError;
use crate::gpu_scene::lighting::Lighting;
use crate::gpu_scene::upload::{GpuScene, UploadError};
use crate::gpu_scene::view::{CameraView, ViewId, Views};
use crate::grading::GradingTables;
use crate::program::Programs;
use crate::settings::frame_index::FrameIndex;
use framegraph_scene::{ProgressFn, Scene};
use framegraph_wgpu::{DeviceError, Gpu};

/// A scene with its light and its views on one device. Lives across frames; [`World::set_view`] replaces a view.
#[derive(Debug)]
pub struct World {
    /// Shaders with their bindings.
    pub programs: Programs,
    /// Meshes, materials and textures on the GPU.
    pub scene: GpuScene,
    /// Image-based light. Can be replaced between frames, together with views made for it.
    pub lighting: Lighting,
    /// Cameras, suns and draw lists.
    pub views: Views,
    /// Color grading tables. Can be changed between frames.
    pub grading: GradingTables,
    /// Index of the frame.
    pub frame_index: FrameIndex,
}

/// Error of creating a world.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum WorldError {
    /// The scene does not fit the device, or loading was interrupted.
    #[error(transparent)]
    Scene(#[from] UploadError),
    /// The device failed.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl std::fmt::Debug for WorldError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl World {
    /// Uploads a scene with one or several views, the first of which is [`ViewId::MAIN`]. Views must belong to the
    /// same scene and light.
    ///
    /// # Errors
    /// Fails as [`WorldError`] describes.
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        lighting: Lighting,
        views: impl IntoIterator<Item = CameraView>,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, WorldError> {
        Ok(Self::of(gpu, GpuScene::upload(gpu, scene, progress)?, lighting, views)?)
    }

    /// Creates a world for an uploaded scene.
    ///
    /// # Errors
    /// Fails if the device fails.
    pub fn of(
        gpu: &Gpu,
        scene: GpuScene,
        lighting: Lighting,
        views: impl IntoIterator<Item = CameraView>,
    ) -> Result<Self, DeviceError> {
        let views = Views::new(gpu, views)?;
        Ok(Self {
            programs: Programs::new(),
            scene,
            lighting,
            views,
            grading: GradingTables::default(),
            frame_index: FrameIndex(0),
        })
    }

    /// Replaces a view. Reuses buffers that are large enough.
    ///
    /// # Errors
    /// Fails if the view does not exist.
    pub fn set_view(&mut self, gpu: &Gpu, id: ViewId, view: CameraView) -> Result<(), PassError> {
        self.views.set(gpu, id, view)
    }
}

impl AsRef<Programs> for World {
    fn as_ref(&self) -> &Programs {
        &self.programs
    }
}

impl AsRef<GpuScene> for World {
    fn as_ref(&self) -> &GpuScene {
        &self.scene
    }
}

impl AsRef<Lighting> for World {
    fn as_ref(&self) -> &Lighting {
        &self.lighting
    }
}

impl AsRef<Views> for World {
    fn as_ref(&self) -> &Views {
        &self.views
    }
}

impl AsRef<FrameIndex> for World {
    fn as_ref(&self) -> &FrameIndex {
        &self.frame_index
    }
}

impl AsRef<GradingTables> for World {
    fn as_ref(&self) -> &GradingTables {
        &self.grading
    }
}
