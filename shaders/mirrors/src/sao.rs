//! Mirror of `wgsl/lib/sao.wgsl`.

use glam::DVec3;
use std::f64::consts::PI;

/// Height at which a tap at the point itself counts fully, in radii.
pub const SAO_PEAK: f64 = 0.1;

/// Returns the distance of tap `index` from the center of the spiral, as a share of its radius.
pub fn sao_tap_distance(index: f64, noise: f64, per_tap: f64) -> f64 {
    ((index + noise + 0.5) * per_tap).powi(2)
}

/// Returns the obscurance by a point at `v` of a surface with unit normal n.
pub fn sao_term(v: DVec3, n: DVec3, radius_m: f64, bias_m: f64, min_sin2: f64) -> f64 {
    let u = v / radius_m;
    let (uu, un) = (u.length_squared(), u.dot(n));
    if uu >= 1.0 || un * un < uu * min_sin2 {
        return 0.0;
    }
    (1.0 - uu).powi(2) * (un - bias_m / radius_m).max(0.0) / (uu + SAO_PEAK * SAO_PEAK)
}

/// Returns the obscured share of the hemisphere, from the mean of the terms.
pub fn sao_obscurance(mean: f64, intensity: f64) -> f64 {
    (2.0 * PI * SAO_PEAK * intensity * mean).max(0.0).sqrt().min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verifies the visibility near the corner of an infinite floor and wall, in an orthographic projection along the
    /// diagonal. All taps of the spiral are evaluated at floor points with known distances from the wall. The expected
    /// values come from a separate computation with another eye, and differ by up to 0.03.
    #[test]
    fn a_corner_converges_to_its_known_visibility() {
        let radius_m: f64 = 0.3;
        for (distance_m, expected) in [(0.02, 0.314), (0.05, 0.490), (0.1, 0.692), (0.15, 0.826), (0.2, 0.918)] {
            let (taps, angles) = (500_i32, 500_i32);
            let mut sum = 0.0;
            for tap in 0..taps {
                let r = radius_m * sao_tap_distance(f64::from(tap), 0.0, 1.0 / f64::from(taps));
                for angle in 0..angles {
                    let (sin, cos) = (2.0 * PI * (f64::from(angle) + 0.5) / f64::from(angles)).sin_cos();
                    let across = r * cos * std::f64::consts::FRAC_1_SQRT_2;
                    // Moves along the view, (1, 0, -1), to the floor z = 0 or the wall x = distance.
                    let way = across.min(distance_m - across);
                    let v = DVec3::new(across + way, r * sin, across - way);
                    sum += sao_term(v, DVec3::Z, radius_m, 0.0, 0.0);
                }
            }
            let visibility = (1.0 - sao_obscurance(sum / f64::from(taps * angles), 1.0)).powi(2);
            assert!((visibility - expected).abs() < 0.03, "{distance_m} m: {visibility} for {expected}");
        }
    }

    #[test]
    fn flat_ground_obscures_nothing_and_a_closed_point_is_black() {
        assert_eq!(sao_term(DVec3::new(0.1, 0.05, 0.0), DVec3::Z, 0.3, 0.0, 0.0), 0.0);
        assert_eq!(sao_term(DVec3::new(0.1, 0.0, 0.3), DVec3::Z, 0.3, 0.0, 0.0), 0.0);
        assert_eq!([0.0, 1e3].map(|mean| sao_obscurance(mean, 1.0)), [0.0, 1.0]);
        // An elevation of 10° is below the minimum angle of 20°.
        let rise = DVec3::new(10_f64.to_radians().cos(), 0.0, 10_f64.to_radians().sin()) * 0.1;
        let least = 20_f64.to_radians().sin().powi(2);
        assert!(sao_term(rise, DVec3::Z, 0.3, 0.0, 0.0) > 0.0);
        assert_eq!(sao_term(rise, DVec3::Z, 0.3, 0.0, least), 0.0);
    }

    #[test]
    fn the_last_tap_is_at_the_end_of_the_spiral() {
        for taps in [3.0, 7.0, 64.0] {
            let per_tap = 1.0 / (taps - 0.5);
            assert!((sao_tap_distance(taps - 1.0, 0.0, per_tap) - 1.0).abs() < 1e-12);
            assert!(sao_tap_distance(0.0, 0.0, per_tap) < sao_tap_distance(1.0, 0.0, per_tap));
        }
    }
}
