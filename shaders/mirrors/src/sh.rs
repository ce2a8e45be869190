//! Mirror of `wgsl/lib/sh.wgsl`, and the projection that computes its coefficients.

use glam::{DVec2, DVec3};

use super::math::PI;

/// Nine pre-convolved coefficients, linear Rec.709.
pub type Sh = [DVec3; 9];

/// Evaluates the basis polynomials 1, y, z, x, xy, yz, 3z² - 1, zx, x² - y² at a unit vector.
fn polynomials(n: DVec3) -> [f64; 9] {
    let DVec3 { x, y, z } = n;
    [1.0, y, z, x, x * y, y * z, 3.0 * z * z - 1.0, z * x, x * x - y * y]
}

/// Sums coefficients times polynomials at n, with bands one and two scaled.
pub fn evaluate_sh(sh: &Sh, n: DVec3, band1: f64, band2: f64) -> DVec3 {
    let scale = [1.0, band1, band1, band1, band2, band2, band2, band2, band2];
    let terms = sh.iter().zip(polynomials(n)).zip(scale);
    terms.map(|((c, p), s)| *c * (p * s)).sum()
}

/// Returns irradiance / π, at least zero.
pub fn irradiance_sh(sh: &Sh, n: DVec3) -> DVec3 {
    evaluate_sh(sh, n, 1.0, 1.0).max(DVec3::ZERO)
}

/// Returns irradiance / π from two bands, at least zero.
pub fn irradiance_sh2(sh: &[DVec3; 4], n: DVec3) -> DVec3 {
    let terms = sh.iter().zip(polynomials(n)).map(|(c, p)| *c * p);
    terms.sum::<DVec3>().max(DVec3::ZERO)
}

/// Returns irradiance / π from five bands without the fourth, at least zero.
pub fn irradiance_sh5(sh: &[DVec3; 18], n: DVec3) -> DVec3 {
    let DVec3 { x, y, z } = n;
    let (x2, y2, z2) = (x * x, y * y, z * z);
    let fifth = [
        x * x2 * y - x * y * y2,
        3.0 * x2 * y * z - y * y2 * z,
        7.0 * x * y * z2 - x * y,
        7.0 * y * z * z2 - 3.0 * y * z,
        35.0 * z2 * z2 - 30.0 * z2 + 3.0,
        7.0 * x * z * z2 - 3.0 * x * z,
        7.0 * (x2 - y2) * z2 - x2 + y2,
        x * x2 * z - 3.0 * x * y2 * z,
        x2 * x2 - 6.0 * x2 * y2 + y2 * y2,
    ];
    let terms = sh.iter().zip(polynomials(n).into_iter().chain(fifth)).map(|(c, p)| *c * p);
    terms.sum::<DVec3>().max(DVec3::ZERO)
}

/// Returns band factors from the cosine lobe to the split-sum GGX lobe. The cubics equal the shader's, which define
/// them.
pub fn sh_lobe_scale(alpha: f64) -> DVec2 {
    let band1 = 0.527_27 + alpha * (-0.550_19 + alpha * 0.169_95);
    let band2 = 3.164_48 + alpha * (-4.350_02 + alpha * 2.027_39);
    DVec2::ONE + (1.0 - alpha) * DVec2::new(band1, band2)
}

/// Returns radiance filtered by the GGX lobe around r.
pub fn specular_sh(sh: &Sh, r: DVec3, alpha: f64) -> DVec3 {
    let scale = sh_lobe_scale(alpha);
    evaluate_sh(sh, r, scale.x, scale.y).max(DVec3::ZERO)
}

/// Projects an environment onto irradiance coefficients. Samples are (unit direction, radiance, solid angle in sr) and
/// cover the sphere. The coefficients include the convolution with the cosine lobe (π, 2π/3, π/4), the division by π,
/// and the squared factors of the polynomials. Radiance must be finite and not negative. CPU only.
pub fn project_irradiance_sh(samples: impl IntoIterator<Item = (DVec3, DVec3, f64)>) -> Sh {
    let mut sh = [DVec3::ZERO; 9];
    for (direction, radiance, solid_angle_sr) in samples {
        for (c, p) in sh.iter_mut().zip(polynomials(direction)) {
            *c += radiance * (p * solid_angle_sr);
        }
    }
    let lobe = [1.0, 2.0 / 3.0, 0.25];
    let factors = [
        lobe[0] / (4.0 * PI),
        lobe[1] * 3.0 / (4.0 * PI),
        lobe[1] * 3.0 / (4.0 * PI),
        lobe[1] * 3.0 / (4.0 * PI),
        lobe[2] * 15.0 / (4.0 * PI),
        lobe[2] * 15.0 / (4.0 * PI),
        lobe[2] * 5.0 / (16.0 * PI),
        lobe[2] * 15.0 / (4.0 * PI),
        lobe[2] * 15.0 / (16.0 * PI),
    ];
    for (c, factor) in sh.iter_mut().zip(factors) {
        *c *= factor;
    }
    sh
}

#[cfg(test)]
mod tests {
    use super::super::environment::equirect_texels;
    use super::*;

    fn project(radiance: impl Fn(DVec3) -> DVec3) -> Sh {
        project_irradiance_sh(equirect_texels(128, 64).map(|t| (t.direction, radiance(t.direction), t.solid_angle_sr)))
    }

    #[test]
    fn a_uniform_environment_lights_evenly() {
        let sh = project(|_| DVec3::new(0.5, 1.0, 2.0));
        for n in [DVec3::X, DVec3::Y, DVec3::new(0.6, -0.64, 0.48)] {
            let e = irradiance_sh(&sh, n);
            assert!((e - DVec3::new(0.5, 1.0, 2.0)).length() < 1e-3, "{n}: {e}");
            let s = specular_sh(&sh, n, 0.3);
            assert!((s - e).length() < 2e-3, "a lobe of any width sees the same");
        }
        let mut uniform = [DVec3::ZERO; 9];
        uniform[0] = DVec3::ONE;
        assert_eq!(irradiance_sh(&uniform, DVec3::X), DVec3::ONE);
    }

    #[test]
    fn fewer_and_more_bands_continue_the_three() {
        let sh = project(|d| DVec3::splat(1.0 + 0.5 * d.y + 0.3 * d.x * d.z));
        let two: [DVec3; 4] = std::array::from_fn(|i| sh[i]);
        let mut five = [DVec3::ZERO; 18];
        five[..9].copy_from_slice(&sh);
        for n in [DVec3::Y, DVec3::new(0.6, -0.64, 0.48)] {
            assert!((irradiance_sh5(&five, n) - irradiance_sh(&sh, n)).length() < 1e-12);
            let linear_only = evaluate_sh(&sh, n, 1.0, 0.0);
            assert!((irradiance_sh2(&two, n) - linear_only).length() < 1e-12);
        }
        // The fifth band's polynomials are orthogonal to each other and to the lower ones.
        let unit = |i: usize| {
            let mut c = [DVec3::ZERO; 18];
            c[i] = DVec3::ONE;
            c
        };
        // Shifted by a constant to stay above the clamp at zero.
        let value = |i: usize, n: DVec3| {
            let mut c = unit(i);
            c[0] += DVec3::splat(100.0);
            irradiance_sh5(&c, n).x - 100.0
        };
        for i in 9..18 {
            for j in 1..i {
                let inner: f64 = equirect_texels(128, 64)
                    .map(|t| value(i, t.direction) * value(j, t.direction) * t.solid_angle_sr)
                    .sum();
                assert!(inner.abs() < 0.05, "{i} {j}: {inner}");
            }
        }
    }

    #[test]
    fn a_gradient_matches_brute_force_integration() {
        let sky = |d: DVec3| DVec3::splat(1.0 + 0.5 * d.y + 0.3 * d.x * d.z + 0.2 * d.z * d.z);
        let sh = project(sky);
        for n in [DVec3::Y, DVec3::NEG_Y, DVec3::X, DVec3::new(0.48, 0.6, -0.64)] {
            let truth: f64 = equirect_texels(256, 128)
                .map(|t| sky(t.direction).x * t.direction.dot(n).max(0.0) * t.solid_angle_sr)
                .sum::<f64>()
                / PI;
            let ours = irradiance_sh(&sh, n).x;
            // Limited to two bands, so exact except for the quadrature with 128×64 cells.
            assert!((ours - truth).abs() < 2e-3, "{n}: {ours} against {truth}");
        }
    }

    #[test]
    fn a_sun_rings_but_never_below_zero() {
        let sh = project(|d| DVec3::splat(if d.y > 0.99 { 1000.0 } else { 0.0 }));
        let lowest = (0..64)
            .map(|i| (f64::from(i) / 32.0 - 1.0).asin())
            .map(|t| irradiance_sh(&sh, DVec3::new(t.cos(), t.sin(), 0.0)).x);
        assert!(lowest.fold(f64::MAX, f64::min) >= 0.0);
        let raw = (0..64)
            .map(|i| (f64::from(i) / 32.0 - 1.0).asin())
            .map(|t| evaluate_sh(&sh, DVec3::new(t.cos(), t.sin(), 0.0), 1.0, 1.0).x);
        assert!(raw.fold(f64::MAX, f64::min) < 0.0, "else the clamp is untested");
    }

    #[test]
    fn the_lobe_scale_follows_the_ggx_lobe() {
        // Band weights of D(θ/2)·cos θ by quadrature, divided by those of the cosine.
        let bands = |alpha: f64| {
            let n = 4000;
            let mut sum = [0.0; 3];
            for i in 0..n {
                let u = (f64::from(i) + 0.5) / f64::from(n);
                let theta = 0.5 * PI * u.powi(3);
                let (c, half) = (theta.cos(), (0.5 * theta).cos());
                let d = alpha / (half * half * (alpha * alpha - 1.0) + 1.0);
                let w = d * d * c * theta.sin() * u * u;
                for (s, p) in sum.iter_mut().zip([1.0, c, 1.5 * c * c - 0.5]) {
                    *s += w * p;
                }
            }
            DVec2::new(1.5 * sum[1] / sum[0], 4.0 * sum[2] / sum[0])
        };
        let mut worst = DVec2::ZERO;
        for i in 1..=64 {
            let alpha = f64::from(i) / 64.0;
            worst = worst.max((sh_lobe_scale(alpha) - bands(alpha)).abs());
        }
        assert!(worst.x < 0.015 && worst.y < 0.081, "{worst}");
        assert_eq!(sh_lobe_scale(1.0), DVec2::ONE, "the two lobes are the same");
    }
}
