//! Image-based light on the device: the panorama as a background, its irradiance and prefiltered radiance, and the table of
//! directional albedo.

use crate::ibl::cache::Cache;
use crate::ibl::{DfgTable, IblError, ImageLight};
use crate::shading::LightSettings;
use crate::upload::{GpuEnvironment, UploadError};
use framegraph_scene::{Environment, ProgressFn};
use framegraph_wgpu::Gpu;

/// An environment as a background and as light. Made once, kept from frame to frame.
#[derive(Debug)]
pub struct Lighting {
    /// The map itself, which the sky shows.
    pub panorama: GpuEnvironment,
    /// Irradiance, the prefiltered cube, and the sun if it is apart.
    pub image: ImageLight,
    /// Directional albedo of the lobes, for one visibility term.
    pub dfg: DfgTable,
}

/// Light could not be made of an environment.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LightingError {
    /// The environment does not fit the device, or uploading it was interrupted.
    #[error(transparent)]
    Upload(#[from] UploadError),
    /// A setting is out of range, making light was interrupted, or the device failed.
    #[error(transparent)]
    Light(#[from] IblError),
}

impl Lighting {
    /// Uploads `environment` and makes light of it, or finds that in `cache`. The work is reported step by step and can be
    /// stopped at each.
    ///
    /// # Errors
    /// When a setting is out of range, when `progress` asks to stop, or when the device fails.
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

    /// What was clamped in the map and what went wrong with the cache, a line each; the light is right all the same.
    pub fn warnings(&self) -> impl Iterator<Item = &str> {
        self.image.warnings.iter().chain(&self.dfg.warnings).map(String::as_str)
    }
}
