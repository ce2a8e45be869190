//! Mirror of `wgsl/lib/anisotropy.wgsl`.

use glam::{DVec2, DVec3};

use super::math::{PI, mix, saturate};

/// Returns alpha along tangent and bitangent, for an isotropic alpha and an anisotropy.
pub fn anisotropic_alpha(alpha: f64, anisotropy: f64, floor: f64) -> DVec2 {
    let a = anisotropy.clamp(-1.0, 1.0);
    DVec2::new(alpha * (1.0 + a), alpha * (1.0 - a)).clamp(DVec2::splat(floor), DVec2::ONE)
}

/// Returns alpha along tangent and bitangent, as specified in KHR_materials_anisotropy.
pub fn gltf_anisotropic_alpha(alpha: f64, strength: f64, floor: f64) -> DVec2 {
    let s = saturate(strength);
    DVec2::new(mix(alpha, 1.0, s * s), alpha).clamp(DVec2::splat(floor), DVec2::ONE)
}

/// Evaluates the anisotropic GGX distribution in 1/sr, in Burley's form.
pub fn d_ggx_anisotropic(alpha: DVec2, toh: f64, boh: f64, noh: f64) -> f64 {
    let q = (toh / alpha.x).powi(2) + (boh / alpha.y).powi(2) + noh * noh;
    1.0 / (PI * alpha.x * alpha.y * q * q)
}

/// Evaluates height-correlated Smith visibility of the anisotropic lobe, from (t, b, n) components.
pub fn v_smith_ggx_correlated_anisotropic(alpha: DVec2, v: DVec3, l: DVec3) -> f64 {
    let slope = |d: DVec3| ((alpha.x * d.x).powi(2) + (alpha.y * d.y).powi(2) + d.z * d.z).sqrt();
    0.5 / (l.z * slope(v) + v.z * slope(l)).max(7.7e-6)
}

/// Returns the normal for reflection from a prefiltered environment, not normalized.
pub fn anisotropic_bent_normal(n: DVec3, across: DVec3, v: DVec3, anisotropy: f64, roughness: f64) -> DVec3 {
    let toward = across.cross(v).cross(across);
    if toward.length_squared() < 1e-8 {
        return n;
    }
    let bend = anisotropy.clamp(-1.0, 1.0).abs() * saturate(5.0 * roughness);
    n + (toward.normalize() - n) * bend
}

#[cfg(test)]
mod tests {
    use super::super::ggx::{d_ggx, v_smith_ggx_correlated};
    use super::*;

    #[test]
    fn without_stretch_it_is_the_isotropic_lobe() {
        for alpha in [0.002_025, 0.1, 1.0] {
            let both = anisotropic_alpha(alpha, 0.0, 0.002);
            for h in [DVec3::Z, DVec3::new(0.36, 0.48, 0.8), DVec3::new(0.6, -0.64, 0.48)] {
                let d = d_ggx_anisotropic(both, h.x, h.y, h.z);
                assert!((d / d_ggx(h.z, alpha) - 1.0).abs() < 1e-9, "{alpha} {h}: {d}");
            }
            let (v, l) = (DVec3::new(0.6, 0.0, 0.8), DVec3::new(-0.64, 0.6, 0.48));
            let stretched = v_smith_ggx_correlated_anisotropic(both, v, l);
            assert!((stretched / v_smith_ggx_correlated(v.z, l.z, alpha) - 1.0).abs() < 1e-9);
        }
    }

    #[test]
    fn stretched_facets_cover_the_surface_exactly() {
        for alpha in [DVec2::new(0.3, 0.6), DVec2::new(1.0, 0.2)] {
            let (rows, columns) = (800, 800);
            let mut area = 0.0;
            for row in 0..rows {
                let cos = (f64::from(row) + 0.5) / f64::from(rows);
                let sin = (1.0 - cos * cos).sqrt();
                for column in 0..columns {
                    let (s, c) = ((f64::from(column) + 0.5) / f64::from(columns) * 2.0 * PI).sin_cos();
                    area += d_ggx_anisotropic(alpha, sin * c, sin * s, cos) * cos;
                }
            }
            area *= 2.0 * PI / f64::from(rows * columns);
            // Error of the midpoint rule with 800² cells.
            assert!((area - 1.0).abs() < 2e-3, "{alpha}: {area}");
        }
    }

    #[test]
    fn the_extremes_of_anisotropy_stay_finite() {
        for a in [-1.0, 1.0, 7.0] {
            let alpha = anisotropic_alpha(0.007_921, a, 0.002_025);
            assert!(alpha.min_element() >= 0.002_025 && alpha.max_element() <= 1.0, "{alpha}");
            assert!(d_ggx_anisotropic(alpha, 0.0, 0.0, 1.0).is_finite());
        }
        assert_eq!(gltf_anisotropic_alpha(0.25, 0.0, 0.01), DVec2::splat(0.25));
        assert_eq!(gltf_anisotropic_alpha(0.25, 1.0, 0.01), DVec2::new(1.0, 0.25));
    }

    #[test]
    fn the_bent_normal_turns_about_the_smooth_direction_to_the_viewer() {
        let (n, v) = (DVec3::Z, DVec3::new(0.6, 0.48, 0.64));
        let bent = anisotropic_bent_normal(n, DVec3::X, v, 1.0, 1.0);
        assert!(bent.dot(DVec3::X).abs() < 1e-12 && bent.dot(v) > 0.0, "{bent}");
        assert_eq!(anisotropic_bent_normal(n, DVec3::X, v, 0.0, 1.0), n);
        assert_eq!(anisotropic_bent_normal(n, DVec3::X, DVec3::X, 1.0, 1.0), n, "no plane to bend into");
    }
}
