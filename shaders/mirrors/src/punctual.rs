//! Mirror of `wgsl/lib/punctual.wgsl`.

use super::math::{saturate, sq};

/// Minimum squared distance, in m².
pub const PUNCTUAL_MIN_DISTANCE2: f64 = 1e-4;

/// Returns inverse square falloff times the range window, in 1/m².
pub fn distance_attenuation(distance2: f64, inv_range2: f64) -> f64 {
    saturate(1.0 - sq(distance2 * inv_range2)) / distance2.max(PUNCTUAL_MIN_DISTANCE2)
}

/// Returns inverse square falloff times the square of the range window, in 1/m².
pub fn distance_attenuation_squared(distance2: f64, inv_range2: f64) -> f64 {
    sq(saturate(1.0 - sq(distance2 * inv_range2))) / distance2.max(PUNCTUAL_MIN_DISTANCE2)
}

/// Returns the fade factor of punctual lights on a surface far from the eye.
pub fn light_far_fade(eye_distance2: f64, inv_far2: f64) -> f64 {
    saturate(5.0 - 5.0 * (eye_distance2 * inv_far2))
}

/// Returns the cone falloff of a spot light.
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

    /// Verifies that at half the range, glTF's window is 15/16 and Filament's is its square.
    #[test]
    fn filaments_window_is_the_square_of_gltfs() {
        let inv = 1.0 / (5.0 * 5.0);
        assert_eq!(distance_attenuation_squared(25.0, inv), 0.0);
        assert_eq!(distance_attenuation_squared(4.0, 0.0), 0.25);
        assert!((distance_attenuation_squared(6.25, inv) - 0.9375 * 0.9375 / 6.25).abs() < 1e-12);
    }

    #[test]
    fn far_lights_fade_over_the_last_tenth() {
        let inv = 1.0 / (100.0 * 100.0);
        for (distance_m, share) in [(0.0, 1.0), (89.0, 1.0), (0.9_f64.sqrt() * 100.0, 0.5), (100.0, 0.0), (1e6, 0.0)] {
            assert!((light_far_fade(distance_m * distance_m, inv) - share).abs() < 1e-12, "{distance_m} m");
        }
    }

    #[test]
    fn a_light_at_the_point_stays_finite() {
        for d2 in [0.0, 1e-30, 1e-6] {
            assert_eq!(distance_attenuation(d2, 0.0), 1e4);
            assert_eq!(distance_attenuation_squared(d2, 0.0), 1e4);
        }
    }

    #[test]
    fn the_cone_is_bounded() {
        for cos in [-2.0, -1.0, 0.0, 0.9, 1.0, 1.5] {
            assert!((0.0..=1.0).contains(&spot_attenuation(cos, 1000.0, -900.0)));
        }
    }
}
