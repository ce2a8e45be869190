//! Mirror of `wgsl/lib/exposure.wgsl`, and the camera settings behind EV100.

/// Lowest exposure value accepted, EV at ISO 100.
pub const EV100_MIN: f64 = -16.0;
/// Highest exposure value accepted, EV at ISO 100.
pub const EV100_MAX: f64 = 24.0;

/// Exposure in 1/nits from EV100.
pub fn exposure_from_ev100(ev100: f64) -> f64 {
    1.0 / (1.2 * ev100.clamp(EV100_MIN, EV100_MAX).exp2())
}

/// EV100 from an exposure in 1/nits.
pub fn ev100_from_exposure(exposure: f64) -> f64 {
    (-(1.2 * exposure.max(1e-9)).log2()).clamp(EV100_MIN, EV100_MAX)
}

/// EV100 of camera settings: aperture in f-stops, shutter time in s, sensitivity in ISO
/// (ISO 2720: EV = log2(N²/t), minus log2(ISO/100)). CPU only.
pub fn ev100_from_camera(aperture: f64, shutter_s: f64, iso: f64) -> f64 {
    (aperture * aperture / shutter_s * 100.0 / iso).log2()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sunny_16_is_about_ev_15() {
        let ev = ev100_from_camera(16.0, 1.0 / 100.0, 100.0);
        assert!((ev - 14.64).abs() < 0.01, "{ev}");
        assert!((exposure_from_ev100(15.0) - 2.543e-5).abs() < 1e-8);
    }

    #[test]
    fn round_trip_over_the_range() {
        for tenth in -160..=240 {
            let ev = f64::from(tenth) / 10.0;
            assert!((ev100_from_exposure(exposure_from_ev100(ev)) - ev).abs() < 1e-12);
        }
    }

    #[test]
    fn extremes_stay_finite_and_positive() {
        for ev in [-1e9, -17.0, 25.0, 1e9, f64::NEG_INFINITY, f64::INFINITY] {
            let exposure = exposure_from_ev100(ev);
            assert!(exposure.is_finite() && exposure > 0.0, "{ev}");
        }
        assert_eq!(ev100_from_exposure(0.0), EV100_MAX);
    }
}
