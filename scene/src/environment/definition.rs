//! What an environment is.

use glam::DVec3;

use super::equirect::EquirectMap;
use super::filtered::FilteredLight;
use crate::color::luminance_from_rec709;
use crate::error::SceneError;
use crate::light::{Light, LightKind};
use crate::scene::Scene;

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

    /// The exposure value at ISO 100 that shows a white card in a scene as white: lit by half the sphere of the environment,
    /// and by the sun at 60° from its normal. Its luminance is E / π, and 1 / (1.2 · 2^EV100) of that is to be 1.
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
