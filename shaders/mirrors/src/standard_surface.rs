//! Mirror of `wgsl/lib/standard_surface.wgsl`.

use glam::DVec3;

use super::diffuse::fd_lambert;
use super::fresnel::f_schlick;
use super::ggx::{d_ggx, v_smith_ggx_correlated, v_smith_ggx_correlated_fast};

/// Surface parameters of the BRDF that do not depend on the light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandardSurface {
    /// Unit shading normal.
    pub normal: DVec3,
    /// Perceptual roughness squared.
    pub alpha: f64,
    /// Unit vector toward the viewer.
    pub view: DVec3,
    /// normal · view, at least 1e-4.
    pub nov: f64,
    /// Albedo of the Lambert layer.
    pub diffuse: DVec3,
    /// Reflectance at normal incidence.
    pub f0: DVec3,
    /// Reflectance at grazing incidence.
    pub f90: f64,
    /// Factor that compensates for multiple scattering.
    pub compensation: DVec3,
}

/// Clamps normal · view to at least 1e-4.
pub fn clamp_nov(nov: f64) -> f64 {
    nov.max(1e-4)
}

/// Returns the unit vector half-way between two unit vectors; shorter for opposite vectors.
pub fn half_vector(a: DVec3, b: DVec3) -> DVec3 {
    let sum = a + b;
    sum / sum.length_squared().max(1e-12).sqrt()
}

/// Evaluates BRDF times cosine toward the unit vector `to_light`.
pub fn reflect_light(s: &StandardSurface, to_light: DVec3, fast_visibility: bool) -> DVec3 {
    let nol = s.normal.dot(to_light).min(1.0);
    if nol <= 0.0 {
        return DVec3::ZERO;
    }
    let h = half_vector(to_light, s.view);
    let visibility = if fast_visibility { v_smith_ggx_correlated_fast } else { v_smith_ggx_correlated };
    let dv = d_ggx(s.normal.dot(h), s.alpha) * visibility(s.nov, nol, s.alpha);
    let specular = f_schlick(s.f0, s.f90, to_light.dot(h)) * dv;
    (s.diffuse * fd_lambert() + specular * s.compensation) * nol
}

#[cfg(test)]
mod tests {
    use super::super::dfg::{Visibility, dfg_integrate, energy_compensation};
    use super::super::math::PI;
    use super::*;

    fn surface(nov: f64, roughness: f64, f0: f64) -> StandardSurface {
        StandardSurface {
            normal: DVec3::Z,
            alpha: roughness * roughness,
            view: DVec3::new((1.0 - nov * nov).sqrt(), 0.0, nov),
            nov,
            diffuse: DVec3::ZERO,
            f0: DVec3::splat(f0),
            f90: 1.0,
            compensation: DVec3::ONE,
        }
    }

    /// Integrates the albedo: BRDF times cosine over the whole hemisphere.
    fn albedo(s: &StandardSurface, fast: bool) -> f64 {
        let (rows, columns) = (400, 400);
        let mut sum = 0.0;
        for row in 0..rows {
            for column in 0..columns {
                let cos = (f64::from(row) + 0.5) / f64::from(rows);
                let azimuth = (f64::from(column) + 0.5) / f64::from(columns) * 2.0 * PI;
                let sin = (1.0 - cos * cos).sqrt();
                let l = DVec3::new(sin * azimuth.cos(), sin * azimuth.sin(), cos);
                sum += reflect_light(s, l, fast).x;
            }
        }
        sum * 2.0 * PI / f64::from(rows * columns)
    }

    #[test]
    fn white_furnace_with_compensation_is_white() {
        for roughness in [0.4, 0.7, 1.0] {
            for nov in [0.2, 0.6, 1.0] {
                for (fast, visibility) in [(false, Visibility::Exact), (true, Visibility::Fast)] {
                    let mut s = surface(nov, roughness, 1.0);
                    let dfg = dfg_integrate(nov, roughness, visibility, 2048);
                    let lossy = albedo(&s, fast);
                    assert!((lossy - dfg.y).abs() < 4e-3, "table and shader agree: {lossy}");
                    s.compensation = energy_compensation(s.f0, dfg.y);
                    let white = albedo(&s, fast);
                    // Quadrature with 400² directions, and 2048 samples.
                    assert!((white - 1.0).abs() < 6e-3, "{roughness} {nov} {fast}: {white}");
                }
            }
        }
    }

    #[test]
    fn without_compensation_rough_metal_loses_the_known_share() {
        // Single scattering loses 14 % at roughness 0.5 and 56 % at 1, at a view angle of 60°.
        for (roughness, loss) in [(0.5, 0.14), (0.7, 0.30), (1.0, 0.56)] {
            let kept = albedo(&surface(0.5, roughness, 1.0), false);
            assert!((1.0 - kept - loss).abs() < 0.02, "{roughness}: {kept}");
        }
    }

    #[test]
    fn light_and_viewer_can_be_swapped() {
        let l = DVec3::new(0.3, 0.4, 0.866).normalize();
        let mut s = surface(0.6, 0.5, 0.3);
        s.diffuse = DVec3::splat(0.5);
        let forward = reflect_light(&s, l, false) / l.z;
        let swapped = StandardSurface { view: l, nov: l.z, ..s };
        let backward = reflect_light(&swapped, s.view, false) / s.nov;
        assert!((forward - backward).length() < 1e-12);
    }

    #[test]
    fn hard_directions_stay_finite_and_dark_below_the_horizon() {
        let s = surface(0.6, 0.045, 1.0);
        assert_eq!(reflect_light(&s, DVec3::X, false), DVec3::ZERO);
        assert_eq!(reflect_light(&s, -s.view, false), DVec3::ZERO);
        let grazing = surface(1e-4, 0.045, 1.0);
        for l in [-grazing.view, DVec3::new(-1.0, 0.0, 1e-8), DVec3::Z * 1.000_000_2] {
            let r = reflect_light(&grazing, l, false);
            assert!(r.is_finite() && r.cmpge(DVec3::ZERO).all(), "{l}: {r}");
        }
    }
}
