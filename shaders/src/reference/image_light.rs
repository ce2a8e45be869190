//! Mirror of `wgsl/lib/image_light.wgsl`.

use super::math::saturate;

/// Returns the mip level to sample for a perceptual roughness.
pub fn specular_lod(roughness: f64, roughness_one_lod: f64) -> f64 {
    let r = saturate(roughness);
    roughness_one_lod * r * (2.0 - r)
}

/// Returns the perceptual roughness that a mip level is filtered for.
pub fn roughness_from_specular_lod(lod: f64, roughness_one_lod: f64) -> f64 {
    1.0 - saturate(1.0 - lod / roughness_one_lod.max(1e-6)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn five_levels_hold_the_stated_roughness() {
        for (lod, r) in [0.0, 0.134, 0.293, 0.5, 1.0].into_iter().enumerate() {
            let got = roughness_from_specular_lod(lod as f64, 4.0);
            assert!((got - r).abs() < 5e-4, "{lod}: {got}");
        }
    }

    #[test]
    fn the_two_are_inverse() {
        for levels in [4.0, 7.0] {
            for i in 0..=100 {
                let r = f64::from(i) / 100.0;
                let back = roughness_from_specular_lod(specular_lod(r, levels), levels);
                // The inverse has a root at one, which loses half of the digits.
                assert!((back - r).abs() < 1e-7, "{r}: {back}");
            }
        }
        assert_eq!(specular_lod(7.0, 4.0), 4.0);
    }
}
