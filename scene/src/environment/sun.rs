//! The sun through a clear atmosphere.

use std::f64::consts::PI;

use glam::DVec3;

use crate::color::luminance_from_rec709;
use crate::light::{Light, LightKind};

/// Mean angular radius of the sun in radians (0.2666°).
pub const SOLAR_ANGULAR_RADIUS_RAD: f64 = 0.004_652;

/// The sun's illuminance above the atmosphere in lux (IES RP-21, "Recommended Practice for the
/// Calculation of Daylight Availability", 1984).
const SOLAR_CONSTANT_LUX: f64 = 127_500.0;

/// Extinction of illuminance per air mass in clear weather (IES RP-21).
const CLEAR_EXTINCTION: f64 = 0.21;

/// Returns the relative air mass at a zenith angle: 1 at the zenith, about 38 at the horizon.
///
/// Kasten and Young, "Revised optical air mass tables", Applied Optics 28, 1989.
pub(super) fn air_mass(zenith_rad: f64) -> f64 {
    let zenith_deg = zenith_rad.min(PI / 2.0).to_degrees();
    1.0 / (zenith_rad.min(PI / 2.0).cos() + 0.505_72 * (96.079_95 - zenith_deg).powf(-1.6364))
}

/// Returns the illuminance of level ground by a clear sky without the sun, in lux: 0.8 + 15.5 √sin(elevation) klx (IES
/// RP-21).
pub(super) fn clear_sky_illuminance_lux(sin_elevation: f64) -> f64 {
    1000.0 * (0.8 + 15.5 * sin_elevation.max(0.0).sqrt())
}

/// Returns the sun as a light, attenuated and colored by a clear atmosphere of this turbidity. `None` below the
/// horizon.
///
/// `toward_sun` is a unit vector. The illuminance uses the extinction of IES RP-21: 95 klx with the sun at 45°, 103 klx
/// at the zenith. The color is the transmittance of Rayleigh scattering and haze at one wavelength per channel: 680,
/// 550 and 440 nm. It is scaled to a luminance of 1, so the hue is approximate and the illuminance exact.
///
/// Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight", 1999, appendix A.1.
#[must_use]
pub fn sun_light(toward_sun: DVec3, turbidity: f64) -> Option<Light> {
    if toward_sun.y <= 0.0 {
        return None;
    }
    let mass = air_mass(toward_sun.y.clamp(0.0, 1.0).acos());
    let illuminance_lux = SOLAR_CONSTANT_LUX * (-CLEAR_EXTINCTION * mass).exp();
    let haze = 0.04608 * turbidity - 0.04586;
    let transmittance = |micrometers: f64| {
        let rayleigh = (-0.008_735 * micrometers.powf(-4.08) * mass).exp();
        rayleigh * (-haze * micrometers.powf(-1.3) * mass).exp()
    };
    let color = DVec3::new(transmittance(0.68), transmittance(0.55), transmittance(0.44));
    let color = color / luminance_from_rec709(color);
    Some(Light {
        kind: LightKind::Directional {
            illuminance_lux: illuminance_lux as f32,
            angular_radius_rad: SOLAR_ANGULAR_RADIUS_RAD as f32,
        },
        color: color.as_vec3(),
        ..Light::directional("sun", (-toward_sun).as_vec3(), illuminance_lux as f32)
    })
}
