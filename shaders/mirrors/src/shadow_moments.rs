//! Mirror of `wgsl/lib/shadow_moments.wgsl`.

use glam::DVec2;

use super::math::saturate;

/// Returns exp(c · (2 depth - 1)).
pub fn warp_depth(depth: f64, exponent: f64) -> f64 {
    (exponent * (2.0 * saturate(depth) - 1.0)).exp()
}

/// Returns warped depth and its square, including the spread within a texel.
pub fn depth_moments(depth: f64, dx: f64, dy: f64, exponent: f64) -> DVec2 {
    let warped = warp_depth(depth, exponent);
    let slope = DVec2::new(dx, dy) * (2.0 * exponent * warped);
    DVec2::new(warped, (warped * warped + 0.25 * slope.dot(slope)).min((2.0 * exponent).exp()))
}

/// Returns the minimum variance of a receiver's warped depth.
pub fn least_variance(warped: f64, exponent: f64, floor_share: f64, texel_slope: DVec2) -> f64 {
    let slope = 2.0 * exponent * warped;
    warped * warped * floor_share + 0.25 * slope * slope * texel_slope.dot(texel_slope).min(0.01)
}

/// Returns the upper bound of the light that reaches a receiver.
pub fn moment_visibility(moments: DVec2, warped: f64, least: f64, bleed: f64) -> f64 {
    if warped <= moments.x {
        return 1.0;
    }
    let variance = (moments.y - moments.x * moments.x).max(least);
    let behind = warped - moments.x;
    saturate((variance / (variance + behind * behind) - bleed) / (1.0 - bleed))
}

#[cfg(test)]
mod tests {
    use super::*;
    use half::f16;

    /// Hard case 44: the exponents are the largest whose moments fit the formats.
    #[test]
    fn hard_case_44_moments_are_finite_in_their_formats() {
        for depth in [0.0, 0.5, 0.9, 1.0, 2.0] {
            for (dx, dy) in [(0.0, 0.0), (1.0, -1.0)] {
                let small = depth_moments(depth, dx, dy, 5.54);
                assert!(f16::from_f64(small.x).is_finite() && f16::from_f64(small.y).is_finite(), "{small}");
                let large = depth_moments(depth, dx, dy, 42.0);
                assert!((large.x as f32).is_finite() && (large.y as f32).is_finite(), "{large}");
            }
        }
        assert!(f16::from_f64(warp_depth(1.0, 5.56).powi(2)).is_infinite());
        assert!((warp_depth(1.0, 44.5).powi(2) as f32).is_infinite());
    }

    /// Hard case 45: a lit plane stays lit when its moments are rounded to half floats.
    #[test]
    fn hard_case_45_a_lit_plane_is_lit_in_half_floats() {
        let floor = (0.5_f64 * 0.01 * 5.54).powi(2);
        for step in 0..=1000 {
            let depth = f64::from(step) / 1000.0;
            let moments = depth_moments(depth, 0.0, 0.0, 5.54);
            let stored = DVec2::new(f16::from_f64(moments.x).to_f64(), f16::from_f64(moments.y).to_f64());
            let warped = warp_depth(depth, 5.54);
            let least = least_variance(warped, 5.54, floor, DVec2::ZERO);
            let lit = moment_visibility(stored, warped, least, 0.15);
            assert!(lit >= 0.99, "{depth}: {lit}");
        }
    }

    /// Verifies light leaks from two occluders above a receiver with gap ratio .75 (`accuracy.md`, 1.6), for c = 5.54
    /// and 42.
    #[test]
    fn the_warp_hides_leaks() {
        let leak = |exponent: f64| {
            let (near, far, receiver) = (0.1, 0.4, 0.5);
            let moments = 0.5 * (depth_moments(near, 0.0, 0.0, exponent) + depth_moments(far, 0.0, 0.0, exponent));
            moment_visibility(moments, warp_depth(receiver, exponent), 0.0, 0.0)
        };
        assert!(leak(5.54) < 0.25 && leak(42.0) < 0.001, "{} {}", leak(5.54), leak(42.0));
        assert!(leak(5.54) > leak(42.0));
    }
}
