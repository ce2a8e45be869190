//! Mirror of `wgsl/lib/fxaa.wgsl`.

use glam::DVec2;

/// Returns true if the contrast is high enough to filter.
pub fn fxaa_is_edge(luma_min: f64, luma_max: f64, threshold: f64, threshold_min: f64) -> bool {
    luma_max - luma_min >= (luma_max * threshold).max(threshold_min)
}

/// Returns the unit direction along the edge, or zero.
pub fn fxaa_direction(nw: f64, ne: f64, sw: f64, se: f64) -> DVec2 {
    let (rising, falling) = (sw - ne, se - nw);
    let d = DVec2::new(rising + falling, rising - falling);
    if d.length_squared() < 1e-12 { DVec2::ZERO } else { d.normalize() }
}

/// Returns the distance of the second tap pair, in texels.
pub fn fxaa_span_texels(direction: DVec2, range: f64, sharpness: f64) -> f64 {
    let largest = direction.abs().max_element();
    2.0 * (range / (largest * sharpness * 0.015).max(1e-6)).min(3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_areas_are_no_edges() {
        for luma in [0.0, 0.2, 1.0] {
            assert!(!fxaa_is_edge(luma, luma, 0.08, 0.04));
        }
        assert!(fxaa_is_edge(0.2, 0.3, 0.08, 0.04));
        assert!(!fxaa_is_edge(0.95, 1.0, 0.08, 0.04), "0.05 is less than 8 % of 1");
    }

    #[test]
    fn the_direction_runs_along_the_edge() {
        // Bright below, dark above: the edge is horizontal.
        assert_eq!(fxaa_direction(0.0, 0.0, 1.0, 1.0).abs(), DVec2::X);
        // Bright to the left: vertical.
        assert_eq!(fxaa_direction(1.0, 0.0, 1.0, 0.0).abs(), DVec2::Y);
        // Bright below left: from top left to bottom right, both components of one sign.
        let d = fxaa_direction(0.5, 0.0, 1.0, 0.5);
        assert!(d.x * d.y > 0.0 && (d.length() - 1.0).abs() < 1e-12);
        assert_eq!(fxaa_direction(0.4, 0.4, 0.4, 0.4), DVec2::ZERO);
    }

    #[test]
    fn the_span_is_at_most_six_texels() {
        assert_eq!(fxaa_span_texels(DVec2::X, 1.0, 8.0), 6.0);
        assert_eq!(fxaa_span_texels(DVec2::ZERO, 1.0, 8.0), 6.0);
        assert!((fxaa_span_texels(DVec2::X, 0.12, 8.0) - 2.0).abs() < 1e-12);
    }
}
