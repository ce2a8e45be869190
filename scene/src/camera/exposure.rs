//! Photographic exposure.

/// Accepted range of exposure values (EV100). Beyond it, exposures leave the useful range of f32.
pub const EV100_RANGE: (f32, f32) = (-16.0, 24.0);

/// Returns the factor from luminance in nits to pre-exposed radiance at ISO 100: 1 / (1.2 · 2^EV100).
///
/// With saturation-based sensitivity and lens factor q = 0.65, the saturation luminance at EV 0 is 1.2 nits. Values
/// outside [`EV100_RANGE`] are clamped; NaN becomes EV 0. Sources: ISO 12232:2006; Lagarde and de Rousiers, "Moving
/// Frostbite to PBR", 2014, section 5.1.
#[must_use]
pub fn exposure_from_ev100(ev100: f32) -> f32 {
    let ev100 = if ev100.is_nan() { 0.0 } else { ev100 };
    1.0 / (1.2 * ev100.clamp(EV100_RANGE.0, EV100_RANGE.1).exp2())
}

/// Returns the exposure value of camera settings: log2(N² / t · 100 / S). N is the f-number, t the shutter time in
/// seconds and S the sensitivity (ISO 2720:1974). Returns `None` unless all are positive and finite.
#[must_use]
pub fn ev100_from_settings(aperture: f32, shutter_s: f32, iso: f32) -> Option<f32> {
    let positive = |v: f32| v > 0.0 && v.is_finite();
    (positive(aperture) && positive(shutter_s) && positive(iso))
        .then(|| (aperture * aperture / shutter_s * 100.0 / iso).log2())
}

/// Returns the exposure value that a reflected-light meter would choose for an average luminance in nits. It is log2(L
/// · S / K) with K = 12.5 and S = 100 (ISO 2720:1974), clamped to [`EV100_RANGE`]. A scene without light gets the
/// lowest value.
#[must_use]
pub fn ev100_from_average_luminance(luminance_nits: f64) -> f32 {
    let ev100 = (luminance_nits.max(0.0) * 100.0 / 12.5).log2() as f32;
    if ev100.is_nan() {
        return EV100_RANGE.0;
    }
    ev100.clamp(EV100_RANGE.0, EV100_RANGE.1)
}
