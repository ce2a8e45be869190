//! Mirror of `wgsl/lib/fresnel.wgsl`.

use glam::DVec3;

use super::math::{pow5, saturate};

/// Evaluates Schlick's approximation.
pub fn f_schlick(f0: DVec3, f90: f64, voh: f64) -> DVec3 {
    f0 + (DVec3::splat(f90) - f0) * pow5(1.0 - saturate(voh))
}

/// Evaluates Schlick's approximation for one channel.
pub fn f_schlick_scalar(f0: f64, f90: f64, voh: f64) -> f64 {
    f0 + (f90 - f0) * pow5(1.0 - saturate(voh))
}

/// Returns the reflectance at grazing incidence for an f0.
pub fn f90_from_f0(f0: DVec3) -> f64 {
    saturate(16.5 * (f0.x + f0.y + f0.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_no_material_lacks_a_bright_edge() {
        assert_eq!(f90_from_f0(DVec3::splat(0.04)), 1.0);
        assert_eq!(f90_from_f0(DVec3::ZERO), 0.0);
        assert!((f90_from_f0(DVec3::splat(0.01)) - 0.495).abs() < 1e-12);
        assert_eq!(f_schlick_scalar(0.04, 1.0, 0.0), 1.0);
    }

    #[test]
    fn ends_and_bounds() {
        let f0 = DVec3::new(0.04, 0.5, 1.0);
        assert_eq!(f_schlick(f0, 1.0, 1.0), f0);
        assert_eq!(f_schlick(f0, 1.0, 0.0), DVec3::ONE);
        for voh in [-0.5, 0.0, 0.3, 1.0, 1.000_5, 2.0] {
            let f = f_schlick(f0, 1.0, voh);
            assert!(f.cmpge(f0).all() && f.cmple(DVec3::ONE).all(), "{voh}: {f}");
        }
    }

    #[test]
    fn glass_is_within_the_known_error_of_the_true_curve() {
        // Unpolarized Fresnel of index 1.5 against Schlick: at most 0.036 (accuracy 1.1).
        let exact = |c: f64| {
            let g = (1.5_f64 * 1.5 - 1.0 + c * c).sqrt();
            let a = ((g - c) / (g + c)).powi(2);
            let b = ((c * (g + c) - 1.0) / (c * (g - c) + 1.0)).powi(2);
            0.5 * a * (1.0 + b)
        };
        let error = (0..=1000)
            .map(|i| f64::from(i) / 1000.0)
            .map(|c| (f_schlick(DVec3::splat(0.04), 1.0, c).x - exact(c)).abs());
        let worst = error.fold(0.0, f64::max);
        assert!((worst - 0.036).abs() < 0.001, "{worst}");
    }
}
