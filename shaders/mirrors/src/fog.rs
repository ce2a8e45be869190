//! Mirror of `wgsl/lib/fog.wgsl`.

/// Maximum exponent to which density is evaluated along a ray.
const MAX_EXPONENT: f64 = 40.0;

/// Returns the mean of e^(-x t) for t in 0…1.
pub fn mean_decay(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { -(-x.clamp(-MAX_EXPONENT, MAX_EXPONENT)).exp_m1() / x }
}

/// Returns the optical depth of a ray whose first `start_m` meters are clear.
pub fn fog_optical_depth(density: f64, decay: f64, start_m: f64, way_m: f64, exact: f64) -> f64 {
    let clear = exact * (start_m / way_m.max(1e-6)).clamp(0.0, 1.0);
    let reached = (-(decay * clear).clamp(-MAX_EXPONENT, MAX_EXPONENT)).exp();
    density * (way_m - start_m).max(0.0) * (reached * mean_decay(decay * (1.0 - clear))).min(1e20)
}

/// Returns the opacity of fog.
pub fn fog_opacity(optical_depth: f64, most: f64) -> f64 {
    (-(-optical_depth).exp_m1()).min(most)
}

/// Returns the share of sunlight that fog scatters toward the eye.
pub fn fog_glow(cos_to_sun: f64, size: f64) -> f64 {
    cos_to_sun.clamp(0.0, 1.0).powf(size)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums the density along the ray at the midpoints of equal steps, as a reference without a closed form.
    fn summed(density: f64, decay: f64, start_m: f64, way_m: f64) -> f64 {
        const STEPS: u32 = 20_000;
        let step_m = (way_m - start_m).max(0.0) / f64::from(STEPS);
        let at = |i| start_m + (f64::from(i) + 0.5) * step_m;
        (0..STEPS).map(|i| density * (-decay * at(i) / way_m).exp() * step_m).sum()
    }

    /// Verifies the closed form. The midpoint rule has an error of decay² / (24 · steps²), which is below 1e-7 here.
    #[test]
    fn optical_depth_is_the_integral_of_density() {
        let mut filament_errs = 0.0_f64;
        for decay in [-8.0, -0.3, -1e-6, 0.0, 1e-6, 0.009, 0.011, 0.5, 8.0] {
            for (start_m, way_m) in [(0.0, 3.0), (2.0, 3.0), (10.0, 500.0), (4.0, 3.0)] {
                let truth = summed(0.2, decay, start_m, way_m);
                let ours = fog_optical_depth(0.2, decay, start_m, way_m, 1.0);
                assert!((ours - truth).abs() <= 1e-6 * truth + 1e-12, "{decay} {start_m} {way_m}: {ours} for {truth}");
                let filament = fog_optical_depth(0.2, decay, start_m, way_m, 0.0);
                assert!(start_m > 0.0 || filament == ours, "the same where nothing is clear");
                filament_errs = filament_errs.max((fog_opacity(filament, 1.0) - fog_opacity(truth, 1.0)).abs());
            }
        }
        assert!(filament_errs > 0.02, "the mean of the whole way is not that of its end: {filament_errs}");
    }

    /// Verifies extremes: zero density hides nothing and dense fog hides everything. Heights of ±1 km neither overflow
    /// nor turn negative.
    #[test]
    fn hard_case_53_transmittance_stays_a_share() {
        for way_m in [0.0, 1e-6, 1.0, 1e5, 1e10] {
            for falloff in [0.0, 1e-6, 1e-5, 0.2, 1.0] {
                for rise_m in [-1000.0, -1e-3, 0.0, 1e-6, 200.0, way_m] {
                    assert_eq!(fog_optical_depth(0.0, falloff * rise_m, 0.0, way_m, 1.0), 0.0);
                    let hidden = fog_opacity(fog_optical_depth(0.1, falloff * rise_m, 0.5, way_m, 1.0), 1.0);
                    assert!((0.0..=1.0).contains(&hidden), "{way_m} {falloff} {rise_m}: {hidden}");
                }
            }
        }
        assert_eq!(fog_opacity(fog_optical_depth(0.1, -1000.0, 0.0, 1000.0, 1.0), 1.0), 1.0);
        assert_eq!(fog_opacity(1e9, 0.7), 0.7);
    }
}
