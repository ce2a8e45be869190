//! Light from all around: an equirectangular radiance map and, if known, the sun apart from it.
//!
//! A sun inside a map is the hardest case for everything that filters it (spherical harmonics ring,
//! importance sampling never converges), so the procedural sky keeps its sun as a [`Light`] and the
//! map free of it.

mod equirect;
mod extract;
mod file;
mod levels;
mod sh;
mod sh_basis;
mod sh_project;
mod sh_window;
mod sky;
mod sun;

pub use equirect::{EquirectMap, direction_from_equirect_uv, equirect_uv_from_direction};
pub use extract::SunExtraction;
pub use file::cleaned;
pub use file::{Cleaning, MAX_RADIANCE};
pub use levels::RadianceLevel;
pub use sh::{Sh, ShBands};
pub use sh_basis::{polynomials, scale as sh_basis_scale};
pub use sh_window::ShWindow;
pub use sky::{Sky, SkyModel};
pub use sun::{SOLAR_ANGULAR_RADIUS_RAD, sun_light};

use std::path::Path;

use glam::DVec3;

use super::error::SceneError;
use super::light::Light;
use super::progress::ProgressFn;

/// What surrounds the scene.
#[derive(Clone, Debug)]
pub struct Environment {
    /// For messages: the file, or what generated it.
    pub name: String,
    /// Radiance of every direction, linear Rec.709. In nits for the procedural sky; files have
    /// whatever unit their maker chose, which is taken for nits.
    pub map: EquirectMap,
    /// The sun, where it is not part of the map.
    pub sun: Option<Light>,
    /// What was repaired while loading, a line each.
    pub warnings: Vec<String>,
}

impl Environment {
    /// Loads a Radiance `.hdr` or OpenEXR `.exr` picture in equirectangular projection. The format
    /// is told from the content.
    ///
    /// Negative, infinite and NaN texels are clamped, counted, and reported in
    /// [`warnings`](Self::warnings).
    ///
    /// # Errors
    ///
    /// One line that names the file and the reason.
    pub fn load(path: &Path, progress: &mut ProgressFn<'_>) -> Result<Self, SceneError> {
        file::load(path, progress)
    }

    /// The same radiance, in nits, from everywhere.
    ///
    /// # Errors
    ///
    /// When a channel is negative or not finite.
    pub fn uniform(radiance_nits: DVec3) -> Result<Self, SceneError> {
        if !(radiance_nits.is_finite() && radiance_nits.min_element() >= 0.0) {
            return Err(SceneError::Parameter {
                parameter: "uniform radiance",
                value: radiance_nits.to_string(),
                range: "0 or more nits in each channel",
            });
        }
        Ok(Self {
            name: format!("uniform {radiance_nits}"),
            map: EquirectMap::from_fn(4, 2, |_| radiance_nits),
            sun: None,
            warnings: Vec::new(),
        })
    }

    /// The mean luminance over all directions in nits, the sun apart.
    #[must_use]
    pub fn average_luminance_nits(&self) -> f64 {
        super::color::luminance_from_rec709(self.map.average())
    }
}

#[cfg(test)]
mod tests;
