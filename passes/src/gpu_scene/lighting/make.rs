//! Creation of image-based light from an environment.

use super::Lighting;
use crate::gpu_scene::upload::{GpuEnvironment, UploadError};
use crate::light::ibl::cache::Cache;
use crate::light::ibl::{DfgTable, IblError, ImageLight};
use crate::light::shading::LightSettings;
use framegraph_scene::{Environment, ProgressFn};
use framegraph_wgpu::Gpu;

/// Error of creating light from an environment.
#[derive(thiserror::Error)]
#[non_exhaustive]
pub enum LightingError {
    /// The environment does not fit the device, or uploading it was interrupted.
    #[error(transparent)]
    Upload(#[from] UploadError),
    /// A setting is out of range, making light was interrupted, or the device failed.
    #[error(transparent)]
    Light(#[from] IblError),
}

impl std::fmt::Debug for LightingError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

impl Lighting {
    /// Uploads `environment` and prefilters it, or loads the result from `cache`. Reports each step to `progress`,
    /// which can stop the work.
    ///
    /// # Errors
    /// Fails if a setting is out of range, `progress` stops the work, or the device fails.
    pub fn new(
        gpu: &Gpu,
        environment: &Environment,
        settings: &LightSettings,
        cache: &Cache,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, LightingError> {
        Ok(Self {
            panorama: GpuEnvironment::upload(gpu, environment, progress)?,
            image: ImageLight::new(gpu, environment, &settings.image, cache, progress)?,
            dfg: DfgTable::new(gpu, settings.dfg, cache, progress)?,
        })
    }
}
