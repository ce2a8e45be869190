//! Image-based light on the device: the panorama as a background, its irradiance and prefiltered radiance, and the table of
//! directional albedo.

use crate::gpu_scene::upload::GpuEnvironment;
use crate::light::ibl::{DfgTable, ImageLight};

#[cfg(feature = "ibl")]
mod make;

#[cfg(feature = "ibl")]
pub use make::LightingError;

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

impl Lighting {
    /// What was clamped in the map and what went wrong with the cache, a line each; the light is right all the same.
    pub fn warnings(&self) -> impl Iterator<Item = &str> {
        self.image.warnings.iter().chain(&self.dfg.warnings).map(String::as_str)
    }
}
