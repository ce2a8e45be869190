//! Image-based light on the device: the panorama as a background, irradiance, prefiltered radiance, and the table of
//! directional albedo.

use crate::gpu_scene::upload::GpuEnvironment;
use crate::light::ibl::{DfgTable, ImageLight};

#[cfg(feature = "ibl")]
mod make;

#[cfg(feature = "ibl")]
pub use make::LightingError;

/// Environment as background and light. Kept across frames.
#[derive(Debug)]
pub struct Lighting {
    /// Panorama that the background shows.
    pub panorama: GpuEnvironment,
    /// Irradiance, prefiltered cube, and the sun if it is separate.
    pub image: ImageLight,
    /// Directional albedo of the lobes, for one visibility term.
    pub dfg: DfgTable,
}

impl Lighting {
    /// Returns one line for each clamped value and each cache error. The light is valid in spite of them.
    pub fn warnings(&self) -> impl Iterator<Item = &str> {
        self.image.warnings.iter().chain(&self.dfg.warnings).map(String::as_str)
    }
}
