//! Mirror of `wgsl/lib/taa.wgsl`.

use glam::DVec3;

/// Converts RGB to YCoCg.
pub fn ycocg_from_rgb(c: DVec3) -> DVec3 {
    DVec3::new(0.25 * c.x + 0.5 * c.y + 0.25 * c.z, 0.5 * (c.x - c.z), 0.5 * c.y - 0.25 * (c.x + c.z))
}

/// Converts YCoCg to RGB.
pub fn rgb_from_ycocg(c: DVec3) -> DVec3 {
    DVec3::new(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z)
}

/// Compresses a color so that its brightest channel is less than 1.
pub fn compress_range(c: DVec3) -> DVec3 {
    c / (1.0 + c.max_element())
}

/// Inverts [`compress_range`]; the result is limited to 65504.
pub fn expand_range(c: DVec3) -> DVec3 {
    c / (1.0 - c.max_element()).max(1.0 / 65504.0)
}

/// Returns the standard deviation of five samples, from their sum and sum of squares.
pub fn deviation_of_five(sum: DVec3, squares: DVec3) -> DVec3 {
    let mean = sum / 5.0;
    (squares / 5.0 - mean * mean).max(DVec3::ZERO).map(f64::sqrt)
}

/// Returns the share of the way from `start` to `end` at which a box begins, 0…1.
pub fn share_to_box(start: DVec3, end: DVec3, low: DVec3, high: DVec3) -> f64 {
    let way = (end - start).map(|d| if d.abs() < 1e-5 { 1e-5 } else { d });
    ((high - start) / way).min((low - start) / way).max_element().clamp(0.0, 1.0)
}

/// Returns a factor on the weight of this frame that reduces flicker.
pub fn steadiness(luma: f64, earlier_luma: f64) -> f64 {
    (1.0 - (luma - earlier_luma).abs() / (0.001 + luma.max(earlier_luma))).powi(2)
}

/// Returns the weights of four texels in a row.
pub fn catmull_rom(f: f64) -> [f64; 4] {
    let half = |x: f64| 0.5 * x;
    [
        half(-f + 2.0 * f.powi(2) - f.powi(3)),
        half(2.0 - 5.0 * f.powi(2) + 3.0 * f.powi(3)),
        half(f + 4.0 * f.powi(2) - 3.0 * f.powi(3)),
        half(-f.powi(2) + f.powi(3)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spaces_are_undone() {
        for c in [DVec3::ZERO, DVec3::new(0.2, 0.7, 1.5), DVec3::new(65504.0, 0.0, 3.0)] {
            assert!((rgb_from_ycocg(ycocg_from_rgb(c)) - c).length() <= 1e-12 * c.length());
            // The brightest color leaves 1/65505 of 1; the inverse limits the factor to 65504.
            assert!((expand_range(compress_range(c)) - c).length() <= 2e-5 * c.length());
        }
        assert_eq!(ycocg_from_rgb(DVec3::splat(0.5)), DVec3::new(0.5, 0.0, 0.0), "grey has no chroma");
    }

    /// Verifies constant neighborhoods, whose box has zero size: other colors are clipped completely, equal colors stay
    /// (hard case 51).
    #[test]
    fn even_neighborhoods_are_boxes_without_width() {
        let flat = DVec3::splat(0.25);
        assert_eq!(deviation_of_five(flat * 5.0, flat * flat * 5.0 * (1.0 - 1e-16)), DVec3::ZERO);
        assert_eq!(share_to_box(flat, flat, flat, flat), 0.0);
        assert_eq!(share_to_box(DVec3::ONE, flat, flat, flat), 1.0);
        let (low, high) = (DVec3::ZERO, DVec3::ONE);
        assert_eq!(share_to_box(DVec3::new(0.5, 0.2, 3.0), DVec3::splat(0.5), low, high), 0.8);
        assert_eq!(share_to_box(DVec3::splat(0.9), DVec3::splat(0.5), low, high), 0.0);
    }

    #[test]
    fn the_spline_passes_through_texels_and_keeps_what_is_even() {
        assert_eq!((catmull_rom(0.0), catmull_rom(1.0)), ([0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]));
        for f in [0.1, 0.5, 0.83] {
            assert!((catmull_rom(f).iter().sum::<f64>() - 1.0).abs() < 1e-15);
        }
        assert_eq!(catmull_rom(0.5), [-0.0625, 0.5625, 0.5625, -0.0625]);
    }

    #[test]
    fn steady_light_counts_whole() {
        assert_eq!(steadiness(0.3, 0.3), 1.0);
        assert!(steadiness(0.0, 10.0) < 1e-7 && steadiness(1.0, 2.0) < steadiness(1.5, 2.0));
    }
}
