//! Mirror of `wgsl/lib/refraction.wgsl`.

use glam::DVec3;

/// Returns the vector from the entry point to the exit point of a sphere.
pub fn refracted_path(view: DVec3, normal: DVec3, ior: f64, thickness: f64) -> DVec3 {
    let eta = 1.0 / ior.max(1.0);
    let cosine = normal.dot(view).clamp(0.0, 1.0);
    let inside = (1.0 - eta * eta * (1.0 - cosine * cosine)).max(0.0).sqrt();
    let ray = normal * (eta * cosine - inside) - view * eta;
    ray * (thickness * inside)
}

/// Returns the index of refraction for red, green and blue. Red and blue each differ from green by half the spread for
/// an Abbe number of 20 / `dispersion`.
pub fn dispersed_ior(ior: f64, dispersion: f64) -> DVec3 {
    let spread = (ior - 1.0) * dispersion / 20.0;
    DVec3::new(ior - 0.5 * spread, ior, ior + 0.5 * spread).clamp(DVec3::ONE, DVec3::splat(1e4))
}

/// Returns the transmittance of each channel.
pub fn transmittance(absorption_per_m: DVec3, distance_m: f64) -> DVec3 {
    (-absorption_per_m * distance_m).exp()
}

/// Returns the standard deviation of the direction of transmitted light, in radians.
pub fn transmission_spread(alpha: f64, ior: f64) -> f64 {
    alpha * (ior - 1.0).max(0.0) / (2.0 * 2.0_f64.ln()).sqrt()
}

/// Returns the standard deviation of Filament's blur behind a rough refractive surface, in radians from the eye.
pub fn seen_transmission_spread(roughness: f64, ior: f64) -> f64 {
    let less = (3.0 / ior.max(1.0) - 2.0).clamp(0.0, 1.0);
    (roughness * (1.0 - less)).powi(2) / 10.0_f64.sqrt()
}

/// Returns the pyramid level for a blur, given in texels of level 0.
pub fn pyramid_lod(sigma_texels: f64) -> f64 {
    (sigma_texels.max(1e-3) / (5.0_f64 / 12.0).sqrt()).log2().max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_bend_by_snells_law_and_cross_a_sphere() {
        let normal = DVec3::Z;
        for degrees in [0.0_f64, 20.0, 60.0, 89.0] {
            let angle = degrees.to_radians();
            let view = DVec3::new(angle.sin(), 0.0, angle.cos());
            for ior in [1.0, 1.33, 2.4] {
                let path = refracted_path(view, normal, ior, 2.0);
                let sine = path.x.hypot(path.y) / path.length();
                assert!((sine * ior - angle.sin()).abs() < 1e-12, "{degrees} {ior}");
                assert!(path.z < 0.0 && path.x <= 0.0);
                // Both ends lie on the sphere of diameter 2 that touches the surface from below.
                let from_center = path + DVec3::Z;
                assert!((from_center.length() - 1.0).abs() < 1e-12, "{degrees} {ior}");
            }
        }
        assert_eq!(refracted_path(DVec3::X, normal, 1.5, 0.0), DVec3::ZERO);
        assert!(refracted_path(DVec3::NEG_Z, normal, 1.0, 1.0).is_finite(), "a normal that faces away");
    }

    /// Verifies the dispersion for an Abbe number of 20, which is (n − 1) over the spread from red to blue.
    #[test]
    fn the_spread_of_indices_is_that_of_the_abbe_number() {
        let [red, green, blue] = dispersed_ior(1.5, 1.0).to_array();
        assert_eq!(green, 1.5);
        assert!((0.5 / (blue - red) - 20.0).abs() < 1e-9 && red < blue);
        assert_eq!(dispersed_ior(1.7, 0.0), DVec3::splat(1.7));
    }

    /// Verifies the spread. Half of GGX's slopes, with density 1/(π α² (1 + m²/α²)²), are below α; half of a Gaussian's
    /// are below σ·√(2 ln 2).
    #[test]
    fn the_spread_holds_half_of_the_facets() {
        let alpha = 0.3;
        let below = |slope: f64| slope * slope / (alpha * alpha + slope * slope);
        assert_eq!(below(alpha), 0.5);
        let sigma = transmission_spread(alpha, 2.0);
        assert!((1.0 - (-alpha * alpha / (2.0 * sigma * sigma)).exp() - 0.5).abs() < 1e-12);
        assert_eq!(transmission_spread(0.5, 1.0), 0.0);
    }

    /// Verifies Filament's blur. Its level is 0.8614 (2 log₂ r − log₂(√2 σ₀ s)) for pixels of s radians. Level 0 is not
    /// blurred. Level 1 has a kernel of σ₀ = 11/3 pixels, and each further level is √5 times wider: r² / (√10 s)
    /// pixels.
    #[test]
    fn filaments_blur_is_that_of_its_levels() {
        let (pixel_rad, sigma_0) = (1e-3, 22.0 / 6.0);
        for roughness in [0.2_f64, 0.4, 0.8] {
            let level = 0.8614 * (2.0 * roughness.log2() - (2.0_f64.sqrt() * sigma_0 * pixel_rad).log2());
            let sigma_px = sigma_0 * 5.0_f64.sqrt().powf(level - 1.0);
            let found = seen_transmission_spread(roughness, 1.5) / pixel_rad;
            assert!((found / sigma_px - 1.0).abs() < 1e-3, "{roughness}: {found} for {sigma_px}");
        }
        assert_eq!(seen_transmission_spread(1.0, 1.0), 0.0);
        assert!(seen_transmission_spread(0.5, 1.2) < seen_transmission_spread(0.5, 1.5));
    }

    /// Verifies the variance of each level, computed kernel by kernel.
    #[test]
    fn levels_of_the_pyramid_have_the_blur_they_are_read_for() {
        let (mut variance, mut texel) = (0.0, 1.0_f64);
        for level in 0..10 {
            let read = variance + texel * texel / 6.0;
            let lod = pyramid_lod(read.sqrt());
            // Level 0 has only the bilinear filter; later levels sum to 5/12·4ⁿ − 1/4.
            let expected = if level == 0 { 0.0 } else { f64::from(level) };
            assert!((lod - expected).abs() < if level < 2 { 0.2 } else { 0.03 }, "{level}: {lod}");
            variance += 0.75 * texel * texel;
            texel *= 2.0;
        }
        assert_eq!(pyramid_lod(0.0), 0.0);
    }
}
