//! Mirror of `wgsl/lib/punctual.wgsl`.

use super::math::{saturate, sq};

/// Smallest squared distance, in m².
pub const PUNCTUAL_MIN_DISTANCE2: f64 = 1e-4;

/// Inverse square falloff times the range window, in 1/m².
pub fn distance_attenuation(distance2: f64, inv_range2: f64) -> f64 {
    saturate(1.0 - sq(distance2 * inv_range2)) / distance2.max(PUNCTUAL_MIN_DISTANCE2)
}

/// Cone falloff of a spot light.
pub fn spot_attenuation(cos_angle: f64, scale: f64, offset: f64) -> f64 {
    sq(saturate(cos_angle * scale + offset))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unlimited_light_falls_with_the_square() {
        for d in [0.1, 1.0, 30.0] {
            assert!((distance_attenuation(d * d, 0.0) * d * d - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_window_closes_at_the_range() {
        let inv = 1.0 / (5.0 * 5.0);
        assert_eq!(distance_attenuation(25.0, inv), 0.0);
        assert_eq!(distance_attenuation(36.0, inv), 0.0);
        assert!((distance_attenuation(6.25, inv) - 0.9375 / 6.25).abs() < 1e-12, "half way");
    }

    #[test]
    fn a_light_at_the_point_stays_finite() {
        for d2 in [0.0, 1e-30, 1e-6] {
            assert_eq!(distance_attenuation(d2, 0.0), 1e4);
        }
    }

    #[test]
    fn the_cone_is_bounded() {
        for cos in [-2.0, -1.0, 0.0, 0.9, 1.0, 1.5] {
            assert!((0.0..=1.0).contains(&spot_attenuation(cos, 1000.0, -900.0)));
        }
    }
}
