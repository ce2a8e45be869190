// Photographic exposure: from EV100 to the factor that turns luminance into a pixel value.
//
// ISO 12232 saturation-based speed with the usual lens transmission of 0.65 puts the largest
// luminance a sensor holds at 1.2 · 2^EV100 nits; exposure is its reciprocal (Lagarde and de
// Rousiers, "Moving Frostbite to PBR", 2014, section 4.7). Always f32: at EV15 it is 2.5e-5,
// a subnormal half that some GPUs flush to zero (hard case 21).

/// Lowest and highest exposure value accepted, in EV at ISO 100.
const EV100_MIN: f32 = -16.0;
const EV100_MAX: f32 = 24.0;

/// Exposure in 1/nits from EV100, which is clamped to [-16, 24].
fn exposure_from_ev100(ev100: f32) -> f32 {
    return 1.0 / (1.2 * exp2(clamp(ev100, EV100_MIN, EV100_MAX)));
}

/// EV100 from an exposure in 1/nits, in [-16, 24]: the inverse of `exposure_from_ev100`.
fn ev100_from_exposure(exposure: f32) -> f32 {
    return clamp(-log2(1.2 * max(exposure, 1e-9)), EV100_MIN, EV100_MAX);
}
