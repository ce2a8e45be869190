//! Environment definition.

use glam::DVec3;

use super::equirect::EquirectMap;
use super::filtered::FilteredLight;
use crate::color::luminance_from_rec709;
use crate::error::SceneError;
use crate::light::{Light, LightKind};
use crate::scene::Scene;

/// Surroundings of the scene: radiance from infinity and the sun.
#[derive(Clone, Debug)]
pub struct Environment {
    /// Name for messages: the file or the generator.
    pub name: String,
    /// Radiance of every direction, linear Rec.709. In nits for the procedural sky; radiance in files, whose unit is
    /// arbitrary, is interpreted as nits.
    pub map: EquirectMap,
    /// The sun, if it is not part of the map.
    pub sun: Option<Light>,
    /// Prefiltered radiance and irradiance from the file, used instead of filtering the map.
    pub filtered: Option<FilteredLight>,
    /// Repairs made while loading, one line each.
    pub warnings: Vec<String>,
}

impl Environment {
    /// Returns an environment with this radiance, in nits, in every direction.
    ///
    /// # Errors
    ///
    /// Fails if a channel is negative or not finite.
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

    /// Returns the mean luminance over all directions in nits, without the sun.
    #[must_use]
    pub fn average_luminance_nits(&self) -> f64 {
        luminance_from_rec709(self.map.average())
    }

    /// Returns the exposure value at ISO 100 at which a white diffuse card appears white. Its luminance E / π times 1 /
    /// (1.2 · 2^EV100) is then 1. The card is lit by a hemisphere of the environment, and by the sun at 60° from its
    /// normal.
    #[must_use]
    pub fn metered_ev100(&self, scene: &Scene) -> f32 {
        let sky_lux = std::f64::consts::PI * self.average_luminance_nits();
        let directional = |kind: LightKind| match kind {
            LightKind::Directional { illuminance_lux, .. } => f64::from(illuminance_lux),
            _ => 0.0,
        };
        let own = self.sun.iter().map(|sun| directional(sun.kind)).sum::<f64>();
        let suns = if own > 0.0 { own } else { scene.lights.iter().map(|l| directional(l.kind)).fold(0.0, f64::max) };
        let nits = (sky_lux + 0.5 * suns) / std::f64::consts::PI;
        if nits > 0.0 { (nits / 1.2).log2() as f32 } else { 0.0 }
    }
}
