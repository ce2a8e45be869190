//! Mirror of `wgsl/lib/cloth.wgsl`.

use glam::DVec3;

use super::math::{PI, saturate};

/// Evaluates the Charlie distribution in 1/sr.
pub fn d_charlie(noh: f64, alpha: f64) -> f64 {
    let c = noh.clamp(0.0, 1.0);
    let sin2 = (1.0 - c * c).max(0.007_812_5);
    let inverse = 1.0 / alpha.max(4e-4);
    (2.0 + inverse) * sin2.powf(0.5 * inverse) / (2.0 * PI)
}

/// Evaluates Ashikhmin's visibility term in Neubelt's form.
pub fn v_neubelt(nov: f64, nol: f64) -> f64 {
    0.25 / (nol + nov - nol * nov).max(1.5e-5)
}

/// Returns the share of light that a sheen layer leaves for the layers below.
pub fn sheen_attenuation(sheen_color: DVec3, cloth_albedo: f64) -> f64 {
    1.0 - saturate(sheen_color.max_element() * cloth_albedo)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fibers_cover_the_surface() {
        // ∫ D cos over the hemisphere is one; computed by substitution of sin θ.
        for roughness in [0.2_f64, 0.5, 1.0] {
            let alpha = roughness * roughness;
            let n = 20_000;
            let cell = |i: i32| {
                let theta = (f64::from(i) + 0.5) / f64::from(n) * 0.5 * PI;
                d_charlie(theta.cos(), alpha) * theta.cos() * theta.sin() * 2.0 * PI * 0.5 * PI / f64::from(n)
            };
            let area: f64 = (0..n).map(cell).sum();
            // The lower limit of sin² slightly increases the integral of rough lobes.
            assert!((area - 1.0).abs() < 2e-3, "{roughness}: {area}");
        }
    }

    #[test]
    fn hard_inputs_stay_finite() {
        for noh in [-1.0, 0.0, 1.0, 1.002] {
            for alpha in [0.0, 4e-4, 1.0] {
                let d = d_charlie(noh, alpha);
                assert!(d.is_finite() && d >= 0.0, "{noh} {alpha}: {d}");
            }
        }
        assert!(v_neubelt(0.0, 0.0) < 16_667.0);
        assert_eq!(v_neubelt(1.0, 1.0), 0.25);
        assert_eq!(sheen_attenuation(DVec3::new(0.2, 0.5, 0.1), 0.4), 0.8);
    }
}
