//! Creation of image-based light from an environment.

use super::Lighting;
use crate::gpu_scene::upload::{GpuEnvironment, UploadError};
use crate::light::ibl::cache::Cache;
use crate::light::ibl::{DfgTable, IblError, ImageLight};
use crate::light::shading::{LightSettings, Quality};
use framegraph_scene::{Environment, ProgressFn, progress};
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
    /// Uploads and prefilters `environment` with the settings of [`Quality::High`] and the cache of
    /// [`Cache::from_env`], without reporting progress.
    ///
    /// # Errors
    /// Fails if the environment does not fit the device, or the device fails.
    pub fn with_defaults(gpu: &Gpu, environment: &Environment) -> Result<Self, LightingError> {
        Self::new(gpu, environment, &Quality::High.light(), &Cache::from_env(), &mut progress::silent)
    }

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
