//! Mirror of `wgsl/lib/night.wgsl`, following the published steps.

use super::primaries::rows;
use glam::{DMat3, DVec3};

/// Responses of long, medium and short cones to linear Rec.709 under D65.
const CONES: DMat3 =
    rows([7.696_847, 18.424_824, 2.068_096], [2.431_137, 18.697_937, 3.012_463], [0.289_117, 1.401_833, 13.792_292]);
/// Response of rods to linear Rec.709 under D65.
const RODS: DVec3 = DVec3::new(0.466_386, 15.564_362, 10.059_963);
/// Maximum sensitivity of the cones (Cao et al. 2008, table 1).
const MOST: DVec3 = DVec3::new(0.637_21, 0.392_42, 1.6064);
/// Rod input to each pathway (Kirk and O'Brien 2011).
const ROD_INPUT: DVec3 = DVec3::new(0.2, 0.2, 0.3);

/// Returns the appearance of linear Rec.709 in night vision.
pub fn night_adaptation(color: DVec3, amount: f64) -> DVec3 {
    // Scale, static saturation, surround of the opponent signal, response ratio to white, weight of long cones.
    let (scale, saturation, surround, ratio, long) = (45.0, 10.0, 0.6, 0.139, 0.6189);
    let opponent_from_cones = DMat3::from_cols(
        DVec3::new(-(surround + ratio), long * surround, long * saturation),
        DVec3::new(1.0 + surround * ratio, (1.0 - long) * surround, (1.0 - long) * saturation),
        DVec3::Y,
    );
    let cones_from_opponent = DMat3::from_cols(DVec3::new(-0.5, 0.5, 0.0), DVec3::Z, DVec3::new(0.5, 0.5, 1.0));
    let lift = 380.0;
    let v = color * lift;
    let (cones, rods) = (CONES * v, RODS.dot(v));
    let excited = (0.33 / MOST) * (cones + ROD_INPUT * rods);
    let gain = DVec3::from_array(excited.to_array().map(|x| (1.0 + x.max(0.0)).sqrt().recip()));
    let opponent = scale / saturation * (opponent_from_cones * (ROD_INPUT / MOST * gain)) * rods * amount;
    CONES.inverse() * (cones + cones_from_opponent * opponent) / lift
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn day_is_day_and_night_is_bluer_and_brighter() {
        let dark = DVec3::splat(0.001);
        assert!((night_adaptation(dark, 0.0) - dark).length() < 1e-15);
        let night = night_adaptation(dark, 1.0);
        assert!(night.z / night.x > 1.2 && night.min_element() > 0.0, "{night}");
        // Bright colors change less.
        let shift = |c: f64| (night_adaptation(DVec3::splat(c), 1.0) / c - 1.0).length();
        assert!(shift(10.0) < 0.3 * shift(0.001), "{} {}", shift(10.0), shift(0.001));
    }
}
