//! Mirror of `wgsl/lib/numerics.wgsl`.

use glam::DVec3;

/// Largest finite half float.
pub const HALF_MAX: f64 = 65504.0;

/// Squared length below which a direction carries no information.
pub const DEGENERATE_LENGTH2: f64 = 1e-12;

/// Clamps x to [0, 65504]; NaN and negative values give 0.
pub fn saturate_half(x: f64) -> f64 {
    if x.is_nan() { 0.0 } else { x.clamp(0.0, HALF_MAX) }
}

/// Applies `saturate_half` to each channel.
pub fn saturate_half3(color: DVec3) -> DVec3 {
    DVec3::from_array(color.to_array().map(saturate_half))
}

/// Returns true if all channels are finite.
pub fn all_finite3(color: DVec3) -> bool {
    color.is_finite()
}

/// Returns v / |v|, or `fallback` if the largest component is at most 1e-30.
pub fn normalize_or(v: DVec3, fallback: DVec3) -> DVec3 {
    let largest = v.abs().max_element();
    if largest > 1e-30 { (v / largest).normalize() } else { fallback }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_saturation_leaves_nothing_that_spreads() {
        for (x, expected) in [
            (f64::NAN, 0.0),
            (f64::INFINITY, HALF_MAX),
            (f64::NEG_INFINITY, 0.0),
            (-0.0, 0.0),
            (-1.0, 0.0),
            (65505.0, HALF_MAX),
            (1.5, 1.5),
        ] {
            assert_eq!(saturate_half(x), expected, "{x}");
        }
    }

    #[test]
    fn normalizing_survives_extremes() {
        for scale in [1e-29, 1e-12, 1.0, 1e30] {
            let n = normalize_or(DVec3::new(3.0, 0.0, 4.0) * scale, DVec3::Y);
            assert!((n - DVec3::new(0.6, 0.0, 0.8)).length() < 1e-15, "{scale}");
        }
        assert_eq!(normalize_or(DVec3::ZERO, DVec3::Y), DVec3::Y);
    }
}
