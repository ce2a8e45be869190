//! Mirror of `wgsl/lib/metal_rough.wgsl`.

use glam::DVec3;

/// Returns the diffuse albedo.
pub fn diffuse_from_base_color(base_color: DVec3, metallic: f64) -> DVec3 {
    base_color * (1.0 - metallic)
}

/// Returns the reflectance at normal incidence.
pub fn f0_from_base_color(base_color: DVec3, metallic: f64, dielectric_f0: DVec3) -> DVec3 {
    dielectric_f0.lerp(base_color, metallic)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dielectrics_and_metals() {
        let base = DVec3::new(0.8, 0.4, 0.1);
        assert_eq!(diffuse_from_base_color(base, 0.0), base);
        assert_eq!(f0_from_base_color(base, 0.0, DVec3::splat(0.04)), DVec3::splat(0.04));
        assert_eq!(diffuse_from_base_color(base, 1.0), DVec3::ZERO);
        assert!((f0_from_base_color(base, 1.0, DVec3::splat(0.04)) - base).length() < 1e-15);
    }
}
