//! What lights a scene from all around, on the device: the panorama that is seen, the light that it gives, and the table
//! that says how much of it lobes reflect.

#[cfg(feature = "ibl")]
use crate::ibl::cache::Cache;
use crate::ibl::{DfgTable, ImageLight};
#[cfg(feature = "ibl")]
use crate::shading::LightSettings;
use crate::upload::GpuEnvironment;
#[cfg(feature = "ibl")]
use crate::world::WorldError;
#[cfg(feature = "ibl")]
use framegraph_scene::{Environment, ProgressFn};
#[cfg(feature = "ibl")]
use framegraph_wgpu::Gpu;

/// An environment, ready to be seen and to light. Made once, kept from frame to frame.
#[derive(Debug)]
pub struct Lighting {
    /// The map itself, which the sky shows.
    pub panorama: GpuEnvironment,
    /// Irradiance, the prefiltered cube, and the sun if it is apart.
    pub image: ImageLight,
    /// Directional albedo of the lobes, for one visibility term.
    pub dfg: DfgTable,
}

impl Lighting {
    /// Uploads `environment` and makes light of it, or finds that in `cache`. The work is reported step by step and can be
    /// stopped at each.
    ///
    /// # Errors
    /// When a setting is out of range, when `progress` asks to stop, or when the device fails.
    #[cfg(feature = "ibl")]
    pub fn new(
        gpu: &Gpu,
        environment: &Environment,
        settings: &LightSettings,
        cache: &Cache,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, WorldError> {
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
