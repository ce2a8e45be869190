//! Mirror of `wgsl/lib/weighted_blending.wgsl`.

use glam::DVec4;

/// Maximum weighted radiance of one fragment.
const WEIGHTED_MAX: f64 = 8000.0;

/// Returns the weight of a fragment, without its factor alpha, at a distance ahead of the eye in m (McGuire and Bavoil
/// 2013, equation 7, divided by 32).
pub fn blend_weight(distance_m: f64) -> f64 {
    let z = distance_m.abs().clamp(0.0, 1e4);
    (10.0 / (1e-5 + (z / 5.0).powi(2) + (z / 200.0).powi(6))).clamp(1e-2, 3e3) / 32.0
}

/// Returns the fragment's contribution to the sums; `color` is premultiplied by alpha.
pub fn weighted_color(color: DVec4, distance_m: f64) -> DVec4 {
    let weight = color.w * blend_weight(distance_m);
    (color.truncate() * weight).min(glam::DVec3::splat(WEIGHTED_MAX)).extend(color.w * weight)
}

#[cfg(test)]
mod tests {
    use super::*;
    use half::f16;

    /// Verifies that nearer fragments have larger weights, and that a sum of eight maximal fragments fits a half float.
    #[test]
    fn weights_fall_with_distance_and_sums_are_half_floats() {
        let mut last = f64::INFINITY;
        for step in 0..=400 {
            let weight = blend_weight(0.01 * 1.04_f64.powi(step));
            assert!(weight <= last && weight > 3e-4, "{step}");
            last = weight;
        }
        let brightest = weighted_color(DVec4::new(65504.0, 65504.0, 65504.0, 1.0), 0.01);
        assert!(f16::from_f64(8.0 * brightest.x).is_finite() && f16::from_f64(64.0 * brightest.w).is_finite());
        // Without the division, the published weights overflow for a radiance of 25.
        assert!(f16::from_f64(32.0 * blend_weight(0.01) * 25.0).is_infinite());
    }

    /// Verifies that a single layer is composited unchanged at any distance.
    #[test]
    fn the_weight_of_a_single_layer_cancels() {
        let color = DVec4::new(0.2, 0.1, 0.05, 0.4);
        for distance_m in [0.0, 0.1, 1.0, 50.0, 1e9] {
            let sum = weighted_color(color, distance_m);
            let off = (sum / sum.w * color.w - color).abs().max_element();
            assert!(off < 1e-12, "{distance_m}: {off}");
        }
    }
}
