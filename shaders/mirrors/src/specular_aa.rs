//! Mirror of `wgsl/lib/specular_aa.wgsl`.

use glam::DVec3;

use super::math::saturate;

/// Returns perceptual roughness, increased by the variance of the normal.
pub fn normal_filtering(roughness: f64, dndx: DVec3, dndy: DVec3, variance: f64, threshold: f64) -> f64 {
    let sigma2 = variance * (dndx.length_squared() + dndy.length_squared());
    saturate(roughness.powi(4) + (2.0 * sigma2).min(threshold)).powf(0.25)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_surfaces_keep_their_roughness_and_bumpy_ones_are_bounded() {
        let flat = normal_filtering(0.3, DVec3::ZERO, DVec3::ZERO, 0.15, 0.2);
        assert!((flat - 0.3).abs() < 1e-12);
        let bumpy = normal_filtering(0.1, DVec3::X, DVec3::Y, 0.15, 0.2);
        assert!((bumpy - (0.1_f64.powi(4) + 0.2).powf(0.25)).abs() < 1e-12, "{bumpy}");
        // Normals that turn five degrees per pixel.
        let five = DVec3::X * 5.0_f64.to_radians();
        let filtered = normal_filtering(0.1, five, five, 0.15, 0.2);
        assert!(filtered > 0.25 && filtered < 0.27, "{filtered}");
    }
}
