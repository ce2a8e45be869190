//! A clear sky by Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight", SIGGRAPH
//! 1999: chromaticity and luminance by Perez's five-parameter distribution.
//!
//! Shape and colors follow the paper. Its zenith luminance makes a clear sky about twice as bright as measured.
//! Luminance is therefore scaled to the horizontal illuminance of a clear sky in IES RP-21, which also defines the
//! sun's illuminance. Sun and sky are thus consistent, in nits and lux.
//!
//! Unlike a gradient the model follows the sun, and unlike Hosek–Wilkie (2012) it needs no tables. Its known weakness,
//! an overly bright horizon in thick haze, lies outside of the accepted range of turbidity.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DVec2, DVec3};

use super::definition::Environment;
use super::equirect::EquirectMap;
use super::sun::{clear_sky_illuminance_lux, sun_light};
use crate::color::{luminance_from_rec709, rec709_from_xyz};
use crate::error::SceneError;
use crate::light::LightKind;

/// Parameters of a clear sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sky {
    /// Direction toward the sun; any length but zero, above the horizon (y > 0).
    pub toward_sun: DVec3,
    /// Haze: 2 is very clear, 3 a normal clear day, 6 hazy.
    pub turbidity: f64,
    /// Diffuse albedo of the ground below the horizon, linear Rec.709 in 0…1.
    pub ground_albedo: DVec3,
}

impl Default for Sky {
    /// Returns a clear afternoon: the sun is 40° high, over the right shoulder of the orbit camera.
    fn default() -> Self {
        let (elevation, azimuth) = (40.0_f64.to_radians(), 75.0_f64.to_radians());
        Self {
            toward_sun: DVec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos()),
            turbidity: 2.5,
            ground_albedo: DVec3::splat(0.2),
        }
    }
}

impl Sky {
    /// Returns the sky as an environment: a map of `width` × `width / 2` texels without the sun's disc, and the sun as
    /// a light.
    ///
    /// # Errors
    ///
    /// Fails if a parameter is out of range; the message names it.
    pub fn environment(&self, width: u32) -> Result<Environment, SceneError> {
        let model = SkyModel::new(self)?;
        if !(8..=4096).contains(&width) {
            return Err(parameter("sky width", width, "8…4096 texels"));
        }
        Ok(Environment {
            name: format!("clear sky, turbidity {}", self.turbidity),
            map: EquirectMap::from_fn(width, width / 2, |direction| model.radiance(direction)),
            sun: sun_light(model.toward_sun, self.turbidity),
            filtered: None,
            warnings: Vec::new(),
        })
    }
}

fn parameter(parameter: &'static str, value: impl Into<f64>, range: &'static str) -> SceneError {
    SceneError::Parameter { parameter, value: value.into(), range }
}

/// Sky with precomputed coefficients, evaluated per direction.
#[derive(Clone, Debug)]
pub struct SkyModel {
    toward_sun: DVec3,
    /// Perez's A…E for luminance Y and chromaticities x, y.
    perez: [[f64; 5]; 3],
    /// Zenith values of Y (in nits after scaling), x and y, each divided by the distribution there.
    zenith: [f64; 3],
    /// Radiance of the ground in nits.
    ground: DVec3,
}

impl SkyModel {
    /// Computes the coefficients and, by integration, the scale and the illuminance of the ground.
    ///
    /// # Errors
    ///
    /// Fails if a parameter is out of range; the message names it.
    pub fn new(sky: &Sky) -> Result<Self, SceneError> {
        let toward_sun = sky
            .toward_sun
            .try_normalize()
            .filter(|d| d.y > 0.0)
            .ok_or_else(|| parameter("y of the sun direction", sky.toward_sun.y, "y > 0: above the horizon"))?;
        if !(2.0..=6.0).contains(&sky.turbidity) {
            return Err(parameter("turbidity", sky.turbidity, "2…6"));
        }
        let albedo = sky.ground_albedo;
        if let Some(channel) = albedo.to_array().into_iter().find(|channel| !(0.0..=1.0).contains(channel)) {
            return Err(parameter("a channel of the ground albedo", channel, "0…1"));
        }
        let t = sky.turbidity;
        let sun_zenith = toward_sun.y.clamp(-1.0, 1.0).acos();
        let perez = [
            [
                0.1787 * t - 1.4630,
                -0.3554 * t + 0.4275,
                -0.0227 * t + 5.3251,
                0.1206 * t - 2.5771,
                -0.0670 * t + 0.3703,
            ],
            [
                -0.0193 * t - 0.2592,
                -0.0665 * t + 0.0008,
                -0.0004 * t + 0.2125,
                -0.0641 * t - 0.8989,
                -0.0033 * t + 0.0452,
            ],
            [
                -0.0167 * t - 0.2608,
                -0.0950 * t + 0.0092,
                -0.0079 * t + 0.2102,
                -0.0441 * t - 1.6537,
                -0.0109 * t + 0.0529,
            ],
        ];
        let at_zenith = [
            zenith_luminance_knits(t, sun_zenith),
            zenith_chromaticity(&ZENITH_X, t, sun_zenith),
            zenith_chromaticity(&ZENITH_Y, t, sun_zenith),
        ];
        let zenith = std::array::from_fn(|i| at_zenith[i] / distribution(&perez[i], 1.0, sun_zenith));
        let mut model = Self { toward_sun, perez, zenith, ground: DVec3::ZERO };
        let sky_lux = clear_sky_illuminance_lux(toward_sun.y);
        model.zenith[0] *= sky_lux / luminance_from_rec709(model.horizontal_irradiance());
        let mut irradiance = model.horizontal_irradiance();
        if let Some(sun) = sun_light(toward_sun, t)
            && let LightKind::Directional { illuminance_lux, .. } = sun.kind
        {
            irradiance += sun.color.as_dvec3() * (f64::from(illuminance_lux) * toward_sun.y);
        }
        model.ground = albedo * irradiance / PI;
        Ok(model)
    }

    /// Returns the radiance from a unit direction in nits, linear Rec.709, never negative, without the sun's disc.
    /// Below the horizon this is the ground, lit by sky and sun.
    #[must_use]
    pub fn radiance(&self, direction: DVec3) -> DVec3 {
        if direction.y <= 0.0 {
            return self.ground;
        }
        let sun_angle = direction.dot(self.toward_sun).clamp(-1.0, 1.0).acos();
        let [luminance, x, y] =
            std::array::from_fn(|i| self.zenith[i] * distribution(&self.perez[i], direction.y.min(1.0), sun_angle));
        let chromaticity = DVec2::new(x, y);
        let xyz =
            DVec3::new(chromaticity.x / chromaticity.y, 1.0, (1.0 - chromaticity.x - chromaticity.y) / chromaticity.y)
                * luminance;
        // Deep blues are slightly outside of Rec.709.
        rec709_from_xyz(xyz).max(DVec3::ZERO)
    }

    /// Returns the sky's irradiance on level ground per channel, without the sun. Midpoint rule over elevation and
    /// azimuth, within 1 % at this step.
    fn horizontal_irradiance(&self) -> DVec3 {
        const ELEVATIONS: u32 = 64;
        const AZIMUTHS: u32 = 128;
        let mut sum = DVec3::ZERO;
        for i in 0..ELEVATIONS {
            let elevation = (f64::from(i) + 0.5) / f64::from(ELEVATIONS) * FRAC_PI_2;
            let (sin, cos) = elevation.sin_cos();
            for j in 0..AZIMUTHS {
                let (s, c) = ((f64::from(j) + 0.5) / f64::from(AZIMUTHS) * 2.0 * PI).sin_cos();
                sum += self.radiance(DVec3::new(cos * s, sin, cos * c)) * (sin * cos);
            }
        }
        sum * (FRAC_PI_2 / f64::from(ELEVATIONS) * 2.0 * PI / f64::from(AZIMUTHS))
    }
}

/// Evaluates Perez's distribution for the sine of an elevation and an angle to the sun.
fn distribution(c: &[f64; 5], sin_elevation: f64, sun_angle: f64) -> f64 {
    let [a, b, c, d, e] = *c;
    let cos_sun = sun_angle.cos();
    // b is negative over the accepted range, so the first exponential falls to 0 at the horizon.
    (1.0 + a * (b / sin_elevation.max(1e-6)).exp()) * (1.0 + c * (d * sun_angle).exp() + e * cos_sun * cos_sun)
}

/// Returns the zenith luminance in thousands of nits (appendix A.2 of the paper).
fn zenith_luminance_knits(t: f64, sun_zenith: f64) -> f64 {
    let chi = (4.0 / 9.0 - t / 120.0) * (PI - 2.0 * sun_zenith);
    (4.0453 * t - 4.9710) * chi.tan() - 0.2155 * t + 2.4192
}

/// Rows for T², T, 1; columns for the sun's zenith angle cubed, squared, linear, and 1.
const ZENITH_X: [[f64; 4]; 3] =
    [[0.00166, -0.00375, 0.00209, 0.0], [-0.02903, 0.06377, -0.03202, 0.00394], [0.11693, -0.21196, 0.06052, 0.25886]];
const ZENITH_Y: [[f64; 4]; 3] =
    [[0.00275, -0.00610, 0.00317, 0.0], [-0.04214, 0.08970, -0.04153, 0.00516], [0.15346, -0.26756, 0.06670, 0.26688]];

fn zenith_chromaticity(table: &[[f64; 4]; 3], t: f64, sun_zenith: f64) -> f64 {
    let s = sun_zenith;
    let row = |r: &[f64; 4]| ((r[0] * s + r[1]) * s + r[2]) * s + r[3];
    (row(&table[0]) * t + row(&table[1])) * t + row(&table[2])
}
