//! What an environment is.

use glam::DVec3;

use super::equirect::EquirectMap;
use super::filtered::FilteredLight;
use crate::color::luminance_from_rec709;
use crate::error::SceneError;
use crate::light::Light;

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
    /// Light that came ready-made with the map, and is taken instead of what would be made of the map.
    pub filtered: Option<FilteredLight>,
    /// What was repaired while loading, a line each.
    pub warnings: Vec<String>,
}

impl Environment {
    /// The same radiance, in nits, from everywhere.
    ///
    /// # Errors
    ///
    /// When a channel is negative or not finite.
    pub fn uniform(radiance_nits: DVec3) -> Result<Self, SceneError> {
        let good = |channel: &f64| channel.is_finite() && *channel >= 0.0;
        if let Some(value) = radiance_nits.to_array().into_iter().find(|channel| !good(channel)) {
            let (parameter, range) = ("a channel of the uniform radiance", "0 nits or more");
            return Err(SceneError::Parameter { parameter, value, range });
        }
        Ok(Self {
            name: format!("uniform {radiance_nits}"),
            map: EquirectMap::from_fn(4, 2, |_| radiance_nits),
            sun: None,
            filtered: None,
            warnings: Vec::new(),
        })
    }

    /// The mean luminance over all directions in nits, the sun apart.
    #[must_use]
    pub fn average_luminance_nits(&self) -> f64 {
        luminance_from_rec709(self.map.average())
    }
}
