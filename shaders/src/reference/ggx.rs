//! Mirror of `wgsl/lib/ggx.wgsl`.

use glam::DVec3;

use super::math::{PI, mix};

/// Returns alpha from perceptual roughness, at least `floor`.
pub fn alpha_from_roughness(roughness: f64, floor: f64) -> f64 {
    let r = roughness.clamp(floor, 1.0);
    r * r
}

/// Evaluates the GGX normal distribution in 1/sr.
pub fn d_ggx(noh: f64, alpha: f64) -> f64 {
    let c = noh.clamp(0.0, 1.0);
    let a2 = alpha * alpha;
    let q = (1.0 - c) * (1.0 + c) + c * c * a2;
    a2 / (PI * q * q)
}

/// Evaluates the GGX normal distribution from vectors, with the sine from their cross product.
pub fn d_ggx_cross(n: DVec3, h: DVec3, noh: f64, alpha: f64) -> f64 {
    let c = noh.clamp(0.0, 1.0);
    let sine2 = if noh <= 0.0 { 1.0 } else { n.cross(h).length_squared() };
    let q = (sine2 + c * c * alpha * alpha).max(1e-12);
    let k = (alpha / q).min(453.5);
    k * k / PI
}

/// Evaluates height-correlated Smith visibility.
pub fn v_smith_ggx_correlated(nov: f64, nol: f64, alpha: f64) -> f64 {
    let a2 = alpha * alpha;
    let lambda_v = nol * (nov * nov * (1.0 - a2) + a2).sqrt();
    let lambda_l = nov * (nol * nol * (1.0 - a2) + a2).sqrt();
    0.5 / (lambda_v + lambda_l).max(7.7e-6)
}

/// Evaluates Hammon's approximation of height-correlated Smith visibility.
pub fn v_smith_ggx_correlated_fast(nov: f64, nol: f64, alpha: f64) -> f64 {
    0.5 / mix(2.0 * nol * nov, nol + nov, alpha).max(7.7e-6)
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROUGHNESS: [f64; 5] = [0.045, 0.089, 0.3, 0.6, 1.0];

    /// Integrates f(θ) over the hemisphere, with angles concentrated near the pole to resolve narrow lobes.
    fn integrate(f: impl Fn(f64) -> f64) -> f64 {
        let n = 20_000;
        let cell = |i: i32| {
            let u = (f64::from(i) + 0.5) / f64::from(n);
            let theta = 0.5 * PI * u.powi(4);
            f(theta) * 2.0 * PI * theta.sin() * 0.5 * PI * 4.0 * u.powi(3) / f64::from(n)
        };
        (0..n).map(cell).sum()
    }

    #[test]
    fn facets_cover_the_surface_exactly() {
        for r in ROUGHNESS {
            let alpha = r * r;
            let area = integrate(|theta| d_ggx(theta.cos(), alpha) * theta.cos());
            assert!((area - 1.0).abs() < 1e-4, "roughness {r}: {area}");
        }
    }

    #[test]
    fn d_stays_within_its_peak() {
        for r in ROUGHNESS {
            let alpha = alpha_from_roughness(r, 0.045);
            let peak = 1.0 / (PI * alpha * alpha);
            for noh in [-1.0, 0.0, 0.5, 0.999_999, 1.0, 1.000_000_2, 1.002] {
                let d = d_ggx(noh, alpha);
                assert!(d >= 0.0 && d <= peak * (1.0 + 1e-12), "roughness {r}, {noh}: {d}");
            }
        }
        assert_eq!(alpha_from_roughness(0.0, 0.045), 0.045 * 0.045);
        assert_eq!(alpha_from_roughness(7.0, 0.045), 1.0);
    }

    #[test]
    fn visibility_is_symmetric_bounded_and_at_alpha_zero_one_over_4() {
        for nov in [0.0, 1e-4, 0.1, 0.5, 1.0] {
            for nol in [0.0, 1e-8, 1e-4, 0.1, 0.5, 1.0] {
                for alpha in [0.002_025, 0.1, 1.0] {
                    let v = v_smith_ggx_correlated(nov, nol, alpha);
                    assert!((0.0..=65504.0).contains(&v), "{nov} {nol} {alpha}: {v}");
                    let swapped = v_smith_ggx_correlated(nol, nov, alpha);
                    assert!((v - swapped).abs() <= 1e-12 * v);
                }
            }
        }
        let mirror = v_smith_ggx_correlated(0.5, 0.8, 0.0);
        assert!((mirror - 1.0 / (4.0 * 0.5 * 0.8)).abs() < 1e-12);
    }

    #[test]
    fn hammon_is_low_by_at_most_28_5_percent() {
        let mut worst: f64 = 0.0;
        for i in 0..60 {
            for j in 0..60 {
                for k in 0..60 {
                    let at = |k: i32, low: f64| low + (1.0 - low) * f64::from(k) / 59.0;
                    let (nov, nol, r) = (at(i, 0.02), at(j, 0.02), at(k, 0.089));
                    let exact = v_smith_ggx_correlated(nov, nol, r * r);
                    let error = v_smith_ggx_correlated_fast(nov, nol, r * r) / exact - 1.0;
                    assert!(error < 1e-12, "it is never high: {error}");
                    worst = worst.min(error);
                }
            }
        }
        assert!((worst + 0.285).abs() < 0.005, "{worst}");
    }

    #[test]
    fn the_cross_product_gives_the_same_lobe_and_forgives_short_normals() {
        let angle = |theta: f64| DVec3::new(theta.sin(), 0.0, theta.cos());
        for r in ROUGHNESS.into_iter().filter(|r| *r > 0.047) {
            let alpha = r * r;
            for theta in [0.0, 0.1 * alpha, alpha, (3.0 * alpha).min(1.5)] {
                let h = angle(theta);
                let ratio = d_ggx_cross(DVec3::Z, h, h.z, alpha) / d_ggx(h.z, alpha);
                assert!((ratio - 1.0).abs() < 1e-6, "{r} {theta}: {ratio}");
            }
        }
        // Accuracy 1.2: with |n| = 0.999, theta = 0.005 and alpha = 0.0079, the cross form gives 1.004 times the
        // reference and the other form 0.002 times.
        let (n, h, alpha) = (DVec3::Z * 0.999, angle(0.005), 0.007_9);
        let truth = d_ggx(h.z, alpha);
        assert!((d_ggx_cross(n, h, n.dot(h), alpha) / truth - 1.004).abs() < 0.002);
        assert!(d_ggx(n.dot(h), alpha) / truth < 0.003);
        assert!(d_ggx_cross(DVec3::Z, DVec3::Z, 1.0, 1e-4) < 65504.0);
        let below = angle(2.0);
        assert_eq!(d_ggx_cross(DVec3::Z, below, below.z, 0.5), d_ggx(below.z, 0.5));
    }
}
