//! Mirror of `wgsl/lib/clear_coat.wgsl`.

use glam::DVec3;

use super::math::{mix, saturate};

/// Evaluates Kelemen's visibility term.
pub fn v_kelemen(loh: f64) -> f64 {
    0.25 / (loh * loh).max(3.9e-6)
}

/// Returns f0 of a layer under a coat of index 1.5, by way of the layer's index of refraction.
pub fn f0_under_clear_coat(f0: DVec3) -> DVec3 {
    DVec3::from_array(f0.to_array().map(|f0| {
        let s = saturate(f0).sqrt();
        if s == 1.0 {
            return 1.0;
        }
        let index = (1.0 + s) / (1.0 - s);
        ((index - 1.5) / (index + 1.5)).powi(2)
    }))
}

/// Returns f0 of a layer under a coat of index 1.5, by Filament's cubic approximation.
pub fn f0_under_clear_coat_fast(f0: DVec3) -> DVec3 {
    let cubic = |f: f64| saturate(f * (f * (0.941_892 - 0.263_008 * f) + 0.346_479) - 0.028_599_8);
    DVec3::from_array(f0.to_array().map(cubic))
}

/// Returns the perceptual roughness of the base as seen through the coat.
pub fn roughness_under_clear_coat(base: f64, coat: f64, strength: f64) -> f64 {
    mix(base, base.max(coat), strength)
}

#[cfg(test)]
mod tests {
    use super::super::ggx::v_smith_ggx_correlated;
    use super::*;

    #[test]
    fn glass_under_glass_disappears_and_metal_stays() {
        let under = f0_under_clear_coat(DVec3::new(0.04, 1.0, 0.5));
        assert!(under.x < 1e-30 && under.y == 1.0, "{under}");
        assert!(under.z < 0.5, "the step to a denser medium is smaller");
    }

    #[test]
    fn the_cubic_is_within_its_stated_error() {
        let worst = |from: i32| {
            let f0 = (from..=1000).map(|i| DVec3::splat(f64::from(i) / 1000.0));
            let apart = f0.map(|f0| (f0_under_clear_coat(f0) - f0_under_clear_coat_fast(f0)).x.abs());
            apart.fold(0.0, f64::max)
        };
        assert!(worst(40) < 0.022, "{}", worst(40));
        // At f0 = 0, the exact value is that of air under the coat, 0.04.
        assert!((worst(0) - 0.04).abs() < 1e-3, "{}", worst(0));
    }

    #[test]
    fn kelemen_is_right_for_glossy_coats() {
        // At roughness 0.089, it matches height-correlated Smith to 1 % (accuracy 1.1).
        let (nov, nol) = (0.8_f64, 0.8_f64);
        let exact = v_smith_ggx_correlated(nov, nol, 0.089 * 0.089);
        let error = v_kelemen(0.8) / exact - 1.0;
        assert!(error.abs() < 0.01, "{error}");
        assert!(v_kelemen(0.0) < 65504.0 && v_kelemen(0.0) > 64000.0);
    }

    #[test]
    fn a_rough_coat_blurs_what_lies_below() {
        assert_eq!(roughness_under_clear_coat(0.1, 0.5, 1.0), 0.5);
        assert_eq!(roughness_under_clear_coat(0.7, 0.5, 1.0), 0.7);
        assert_eq!(roughness_under_clear_coat(0.1, 0.5, 0.0), 0.1);
    }
}
