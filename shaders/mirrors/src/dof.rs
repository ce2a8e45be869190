//! Mirror of `wgsl/lib/dof.wgsl`.

use glam::{DVec2, DVec4};

/// Radius of the circle of confusion, in pixels, below which a pixel is in focus.
const IN_FOCUS: f64 = 1.0;

/// Returns the reciprocal of the distance from the eye's plane, in 1/m, for a reversed depth.
pub fn inverse_distance(depth: f64, row: DVec4) -> f64 {
    (depth * row.z - row.x) / (depth * row.w - row.y)
}

/// Returns the signed radius of the circle of confusion, in pixels.
pub fn coc_radius(per_m: f64, focus_m: f64, scale_px: f64, most: DVec2) -> f64 {
    let radius = (0.5 * scale_px * (1.0 - focus_m * per_m)).clamp(-most.x, most.y);
    if radius.abs() < IN_FOCUS { 0.0 } else { radius }
}

/// Returns the opacity of an out-of-focus pixel.
pub fn coc_opacity(radius: f64) -> f64 {
    (radius.abs() - IN_FOCUS).clamp(0.0, 1.0)
}

/// Returns 1 if a circle of confusion covers a point at this distance, fading to 0 outside.
pub fn coc_reaches(radius: f64, distance_px: f64, texel_px: f64) -> f64 {
    ((radius - distance_px) / texel_px + 0.5).clamp(0.0, 1.0)
}

/// Returns the light density inside a circle of confusion.
pub fn coc_density(radius: f64, texel_px: f64) -> f64 {
    1024.0 / (radius * radius).max(2.0 * texel_px)
}

/// Returns the mip level for taps on rings.
pub fn ring_level(rings: f64, radius_texels: f64) -> f64 {
    ((radius_texels.max(1e-3) / (rings - 0.5)).log2() + 0.5).floor().max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verifies a thin lens. The circle is a point in focus, and has the full diameter at infinity. At half the focus
    /// distance it is equally large, in the foreground.
    #[test]
    fn circles_are_those_of_a_thin_lens() {
        let most = DVec2::splat(1000.0);
        let radius = |distance_m: f64| coc_radius(1.0 / distance_m, 4.0, 40.0, most);
        assert_eq!((radius(4.0), radius(f64::INFINITY), radius(2.0)), (0.0, 20.0, -20.0));
        // Infinite projection with its near plane at 0.1 m: depth is 0.1 over the distance.
        let row = DVec4::new(0.0, 0.1, -1.0, 0.0);
        assert!((inverse_distance(0.025, row) - 0.25).abs() < 1e-12 && inverse_distance(0.0, row) == 0.0);
        // Finite perspective and orthographic projections, from 0.1 m to 10 m.
        let (near, far) = (0.1, 10.0);
        let central = DVec4::new(near / (far - near), near * far / (far - near), -1.0, 0.0);
        let parallel = DVec4::new(1.0 / (far - near), far / (far - near), 0.0, 1.0);
        for distance_m in [0.1_f64, 2.5, 10.0] {
            for row in [central, parallel] {
                let depth = (row.x * -distance_m + row.y) / (row.z * -distance_m + row.w);
                assert!((inverse_distance(depth, row) * distance_m - 1.0).abs() < 1e-9, "{distance_m} {row}");
            }
        }
    }
}
