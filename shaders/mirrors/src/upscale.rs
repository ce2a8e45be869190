//! Mirror of `wgsl/lib/upscale.wgsl`, and of the complete filter.

use super::luminance::luminance;
use glam::{DVec2, DVec3, DVec4};

/// Returns the edge through a texel, estimated from its four neighbors.
pub fn edge_of(middle: f64, up: f64, left: f64, right: f64, down: f64) -> DVec3 {
    let (x, y) = (right - left, down - up);
    let straight =
        |way: f64, a: f64, b: f64| (way.abs() / (a - middle).abs().max((b - middle).abs()).max(1e-5)).min(1.0);
    DVec3::new(x, y, straight(x, left, right).powi(2) + straight(y, up, down).powi(2))
}

/// Returns the elliptical kernel of an edge.
pub fn kernel_of(edge: DVec3) -> DVec4 {
    let along = edge.truncate();
    let direction = if along.length_squared() < 1.0 / 32768.0 { DVec2::X } else { along.normalize() };
    let strength = (0.5 * edge.z).powi(2);
    let stretch = 1.0 / direction.abs().max_element();
    DVec4::new(direction.x, direction.y, 1.0 + (stretch - 1.0) * strength, 1.0 - 0.5 * strength)
}

/// Returns the weight of a texel at this offset.
pub fn kernel_weight(offset: DVec2, kernel: DVec4, straight: f64) -> f64 {
    let direction = DVec2::new(kernel.x, kernel.y);
    let turned = DVec2::new(offset.dot(direction), offset.dot(direction.perp()));
    let lobe = 0.5 - 0.29 * (0.5 * straight).powi(2);
    let squared = (turned * DVec2::new(kernel.z, kernel.w)).length_squared().min(1.0 / lobe);
    let (base, window) = (0.4 * squared - 1.0, lobe * squared - 1.0);
    (25.0 / 16.0 * base * base - 9.0 / 16.0) * window * window
}

/// Upscales an encoded image at a position in texels from the top left. The result is clamped to the range of the four
/// nearest texels.
pub fn upscaled(texel: impl Fn(i64, i64) -> DVec3, place: DVec2) -> DVec3 {
    let corner = (place - 0.5).floor();
    let share = place - 0.5 - corner;
    let at = |x: i64, y: i64| texel(corner.x as i64 + x, corner.y as i64 + y);
    let luma = |x: i64, y: i64| luminance(at(x, y));
    let mut edge = DVec3::ZERO;
    for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
        let weight = (if x == 0 { 1.0 - share.x } else { share.x }) * (if y == 0 { 1.0 - share.y } else { share.y });
        let own = edge_of(luma(x, y), luma(x, y - 1), luma(x - 1, y), luma(x + 1, y), luma(x, y + 1));
        edge += weight * own;
    }
    let kernel = kernel_of(edge);
    let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
    for y in -1..=2_i64 {
        for x in -1..=2_i64 {
            // The four corners are left out.
            if !((x == -1 || x == 2) && (y == -1 || y == 2)) {
                let weight = kernel_weight(DVec2::new(x as f64, y as f64) - share, kernel, edge.z);
                (sum, weights) = (sum + weight * at(x, y), weights + weight);
            }
        }
    }
    let near = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
    let (low, high) = near.iter().fold((near[0], near[0]), |(low, high), c| (low.min(*c), high.max(*c)));
    (sum / weights).clamp(low, high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verifies that constant areas stay constant, and that a vertical step stays steeper than with linear
    /// interpolation.
    #[test]
    fn even_areas_stay_and_steps_stay_steep() {
        assert_eq!(edge_of(0.3, 0.3, 0.3, 0.3, 0.3), DVec3::ZERO);
        assert_eq!(kernel_of(DVec3::ZERO), DVec4::new(1.0, 0.0, 1.0, 1.0));
        let even = upscaled(|_, _| DVec3::splat(0.37), DVec2::new(3.3, 2.9));
        assert!((even - 0.37).length() < 1e-12);
        assert_eq!(edge_of(0.5, 0.5, 0.0, 1.0, 0.5), DVec3::new(1.0, 0.0, 1.0));
        let step = |x: i64, _: i64| DVec3::splat(if x < 4 { 0.1 } else { 0.9 });
        let quarter = upscaled(step, DVec2::new(3.75, 2.5)).x;
        assert!((0.1..0.3).contains(&quarter), "a line has 0.3: {quarter}");
        assert_eq!(upscaled(step, DVec2::new(2.5, 2.5)).x, 0.1);
    }

    #[test]
    fn weights_fall_from_the_middle() {
        let round = DVec4::new(1.0, 0.0, 1.0, 1.0);
        assert_eq!(kernel_weight(DVec2::ZERO, round, 0.0), 1.0);
        assert!(kernel_weight(DVec2::X, round, 0.0) < 0.3 && kernel_weight(DVec2::new(1.3, 0.0), round, 0.0) < 0.0);
        assert!(kernel_weight(DVec2::new(3.0, 0.0), round, 0.0).abs() < 1e-12, "nothing beyond two texels");
    }
}
