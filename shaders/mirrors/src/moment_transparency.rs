//! Mirror of `wgsl/lib/moment_transparency.wgsl`.

use glam::{DVec2, DVec4};

/// Absorbance of an opaque surface.
pub const OPAQUE_ABSORBANCE: f64 = 10.0;

/// Total absorbance below which surfaces count as fully transparent.
const LEAST_ABSORBANCE: f64 = 0.001;

/// Returns the absorbance of a surface with this alpha, 0…10.
pub fn absorbance(alpha: f64) -> f64 {
    (-(1.0 - alpha).max(1e-5).ln()).min(OPAQUE_ABSORBANCE)
}

/// Returns the transmittance of surfaces with this total absorbance.
pub fn transmittance_of(total: f64) -> f64 {
    if total >= OPAQUE_ABSORBANCE { 0.0 } else { (-total.max(0.0)).exp() }
}

/// Returns the logarithm of a distance in m, mapped from the range to −1…1.
pub fn warped_distance(distance_m: f64, range: DVec2) -> f64 {
    (distance_m.max(1e-6).log2() * range.x + range.y).clamp(-1.0, 1.0)
}

/// Returns the first four powers.
pub fn power_moments(at: f64) -> DVec4 {
    DVec4::new(at, at * at, at.powi(3), at.powi(4))
}

/// Returns `x` if its magnitude is at least `least`; otherwise `least` with the sign of `x`.
pub fn divisor(x: f64, least: f64) -> f64 {
    if x.abs() < least { least.copysign(if x < 0.0 { -1.0 } else { 1.0 }) } else { x }
}

/// Returns the share of light that passes all surfaces nearer than `at`; see the shader for the arguments.
pub fn moment_transmittance(total: f64, moments: DVec4, at: f64, bias: f64, overestimation: f64) -> f64 {
    if total < LEAST_ABSORBANCE {
        return 1.0;
    }
    let b = (moments / total).lerp(DVec4::new(0.0, 0.375, 0.0, 0.375), bias);
    let variance = (b.y - b.x * b.x).max(1e-7);
    let skew = b.z - b.x * b.y;
    let l = skew / variance;
    let rest = (b.w - b.y * b.y - skew * l).max(1e-8);
    let forward = at * at - b.y - l * (at - b.x);
    let c2 = forward / rest;
    let c1 = (at - b.x) / variance - l * c2;
    let c0 = 1.0 - c1 * b.x - c2 * b.y;
    let leading = divisor(c2, 1e-6);
    let (half_p, q) = (0.5 * c1 / leading, c0 / leading);
    let root = (half_p * half_p - q).max(0.0).sqrt();
    let larger = if half_p < 0.0 { root - half_p } else { -half_p - root };
    let smaller = q / divisor(larger, 1e-6);
    let [f0, f1, f2] = [overestimation, f64::from(larger < at), f64::from(smaller < at)];
    let f01 = (f1 - f0) / divisor(larger - at, 1e-6);
    let f12 = (f2 - f1) / divisor(smaller - larger, 1e-6);
    let f012 = (f12 - f01) / divisor(smaller - at, 1e-6);
    let slope = f01 - f012 * larger;
    let share = f0 - slope * at + (slope - f012 * at) * b.x + f012 * b.y;
    (-total * share.clamp(0.0, 1.0)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use half::f16;

    /// Bias for 32-bit sums (from the paper) and for half-float sums.
    const BIAS: [f64; 2] = [5e-7, 2e-3];

    /// Sums absorbance and moments of layers, given by alpha and warped distance. Rounds to half floats if `half`.
    fn sums(layers: &[(f64, f64)], half: bool) -> (f64, DVec4) {
        let stored = |x: f64| if half { f16::from_f64(x).to_f64() } else { f64::from(x as f32) };
        let (mut total, mut moments) = (0.0, DVec4::ZERO);
        for (at, alpha) in layers {
            let own = absorbance(*alpha);
            total = stored(total + stored(own));
            moments += DVec4::from_array((power_moments(*at) * own).to_array().map(stored));
            moments = DVec4::from_array(moments.to_array().map(stored));
        }
        (total, moments)
    }

    fn seen(layers: &[(f64, f64)], at: f64, half: bool) -> f64 {
        let (total, moments) = sums(layers, half);
        moment_transmittance(total, moments, at, BIAS[usize::from(half)], 0.25)
    }

    /// Verifies that one layer, or two at equal distances, hide nothing in front and everything they should behind.
    #[test]
    fn hard_case_58_one_distance_hides_what_is_behind_it_and_nothing_in_front() {
        for half in [false, true] {
            for (layers, alpha) in [(vec![(0.3, 0.5)], 0.5), (vec![(0.3, 0.5), (0.3, 0.5)], 0.75)] {
                for (at, truth) in [(-0.9, 1.0), (0.0, 1.0), (0.6, 1.0 - alpha), (0.95, 1.0 - alpha)] {
                    let off = seen(&layers, at, half) - truth;
                    let most = if half { 0.03 } else { 2e-5 };
                    assert!(off.abs() < most, "{layers:?} at {at}, half {half}: off by {off}");
                }
                // At the layer itself, a quarter of it counts.
                let own = seen(&layers, 0.3, half);
                assert!(own >= (1.0_f64 - alpha).powf(0.3) - 0.02 && own <= 1.0, "{own}");
            }
        }
    }

    /// Verifies that two separate layers are resolved exactly; four moments suffice for them.
    #[test]
    fn two_layers_are_told_apart() {
        for half in [false, true] {
            for (at, truth) in [(-0.8, 1.0), (-0.1, 0.7), (0.2, 0.7), (0.8, 0.28)] {
                let off = seen(&[(-0.4, 0.3), (0.5, 0.6)], at, half) - truth;
                let most = if half { 0.1 } else { 1e-3 };
                assert!(off.abs() < most, "at {at}, half {half}: off by {off}");
            }
        }
    }

    /// Verifies that an opaque layer blocks all light behind it and none in front.
    #[test]
    fn hard_case_58_a_layer_that_hides_everything_hides_it() {
        for half in [false, true] {
            assert_eq!(transmittance_of(sums(&[(0.1, 1.0)], half).0), 0.0);
            assert!(seen(&[(0.1, 1.0)], 0.5, half) < 1e-3 && seen(&[(0.1, 1.0)], -0.5, half) > 0.85);
            assert!(seen(&[(0.1, 1.0), (0.6, 0.5)], -0.5, half) > 0.7);
        }
        assert_eq!((transmittance_of(0.0), absorbance(0.0), absorbance(2.0)), (1.0, 0.0, 10.0));
    }

    /// Verifies that half floats need a larger bias than the paper's. With the paper's bias, a surface far behind an
    /// opaque layer keeps up to a quarter of its weight; with ours it keeps none.
    #[test]
    fn half_floats_need_a_larger_bias() {
        let worst = |bias: f64| {
            let ends = (0..400).map(|step| f64::from(step) / 4000.0);
            let seen = ends.map(|inside| {
                let [front, behind] = [-1.0 + inside, 1.0 - 0.7 * inside];
                let (total, moments) = sums(&[(front, 1.0), (behind, 0.5)], true);
                let weight = |at| moment_transmittance(total, moments, at, bias, 0.25);
                0.5 * weight(behind) / (weight(front) + 0.5 * weight(behind))
            });
            seen.fold(0.0, f64::max)
        };
        let [paper, own] = [worst(6e-5), worst(BIAS[1])];
        assert!(paper > 0.05 && own < 0.01, "{paper} {own}");
    }

    /// Verifies that the result stays in 0…1 for any range, for rounded and therefore inconsistent sums, and at the
    /// ends.
    #[test]
    fn hard_case_58_nothing_makes_it_other_than_a_share() {
        let ats = [-1.0, -0.999, -1e-6, 0.0, 0.3, 0.999, 1.0];
        for total in [0.0, 1e-4, 0.001, 0.5, 10.0, 640.0, 65504.0] {
            for m in ats.map(|at| power_moments(at) * total) {
                for off in [0.0, 1e-3, -1e-3, 0.5, -2.0] {
                    let wrong = m + DVec4::new(off, -off, off, -2.0 * off) * total;
                    for at in ats {
                        for bias in [0.0, 5e-7, 2e-3] {
                            let share = moment_transmittance(total, wrong, at, bias, 0.25);
                            assert!((0.0..=1.0).contains(&share), "{total} {wrong} {at} {bias}: {share}");
                        }
                    }
                }
            }
        }
        let range = DVec2::new(2.0 / 40.0, 0.0);
        assert_eq!(
            [0.0, 1e-12, 1.0, 1e12].map(|m| warped_distance(m, range)),
            [(1e-6_f64.log2() / 20.0).max(-1.0), (1e-6_f64.log2() / 20.0).max(-1.0), 0.0, 1.0]
        );
    }
}
