//! Mirror of `wgsl/lib/tone_map.wgsl`.

use super::aces::tone_aces;
use super::agx::tone_agx;
use super::display_range::tone_display_range;
use super::gamut::map_into_gamut;
use super::grading::{positive_power, scale_luminance};
use super::gt7::tone_gt7;
use super::primaries::{LUMINANCE_REC709, LUMINANCE_REC2020, rec709_from_rec2020, rec2020_from_rec709};
use super::srgb::linear_from_srgb;
use glam::{DMat3, DVec3};

fn input(color: DVec3) -> DVec3 {
    color.clamp(DVec3::ZERO, DVec3::splat(100.0))
}

/// Evaluates ACES 1.0 as fitted by Hill.
pub fn tone_map_hill(color: DVec3) -> DVec3 {
    let into = DMat3::from_cols_array_2d(&[
        [0.59719, 0.35458, 0.04823],
        [0.07600, 0.90834, 0.01566],
        [0.02840, 0.13383, 0.83777],
    ]);
    let out_of = DMat3::from_cols_array_2d(&[
        [1.60475, -0.53108, -0.07367],
        [-0.10208, 1.10813, -0.00605],
        [-0.00327, -0.07276, 1.07602],
    ]);
    // The rows above are rows of the matrices, hence the transposes.
    let v = into.transpose() * input(color);
    let fit = (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951_0) + 0.238_081);
    (out_of.transpose() * fit).clamp(DVec3::ZERO, DVec3::ONE)
}

/// Evaluates Narkowicz' per-channel curve.
pub fn tone_map_filmic(color: DVec3) -> DVec3 {
    let c = input(color);
    ((c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14)).clamp(DVec3::ZERO, DVec3::ONE)
}

/// Returns sRGB encoded display light; the curve includes the transfer function.
pub fn tone_map_mobile(color: DVec3) -> DVec3 {
    let c = input(color);
    (c / (c + 0.155) * 1.019).clamp(DVec3::ZERO, DVec3::ONE)
}

/// Evaluates Khronos PBR Neutral.
pub fn tone_map_neutral(color: DVec3) -> DVec3 {
    let c = input(color);
    let lowest = c.min_element();
    let offset = if lowest < 0.08 { lowest - 6.25 * lowest * lowest } else { 0.04 };
    let shifted = c - offset;
    let peak = shifted.max_element();
    if peak < 0.76 {
        return shifted;
    }
    let new_peak = 1.0 - 0.24 * 0.24 / (peak + 0.24 - 0.76);
    let white = 1.0 - 1.0 / (0.15 * (peak - new_peak) + 1.0);
    let scaled = shifted * (new_peak / peak);
    (scaled + (DVec3::splat(new_peak) - scaled) * white).clamp(DVec3::ZERO, DVec3::ONE)
}

/// Evaluates the generic curve with contrast, input scale and output scale.
pub fn tone_generic(color: DVec3, curve: DVec3) -> DVec3 {
    let c = color.clamp(DVec3::ZERO, DVec3::splat(65504.0)).to_array();
    DVec3::from_array(c.map(|x| {
        let power = positive_power(x, curve.x);
        curve.z * power / (power + curve.y)
    }))
}

/// Returns true if input and output of a curve are in Rec.2020.
pub fn tone_in_rec2020(curve: u32) -> bool {
    !matches!(curve, 0..=3 | 13)
}

/// Returns the display light of a color, both in the primaries of the curve.
pub fn tone_curve(color: DVec3, curve: u32, generic: DVec3) -> DVec3 {
    match curve {
        1 => tone_map_hill(color),
        2 => tone_map_filmic(color),
        3 => tone_map_neutral(color),
        4 => tone_aces(color, 1.0 / 0.6),
        6 => tone_aces(color, 1.0),
        7..=9 => tone_agx(color, curve - 7),
        10 => tone_gt7(color),
        11 => tone_generic(color, generic),
        12 => tone_display_range(color),
        13 => linear_from_srgb(tone_map_mobile(color)),
        _ => color.clamp(DVec3::ZERO, DVec3::ONE),
    }
}

/// Tone maps linear Rec.709 scene light to linear Rec.709 display light.
pub fn tone_map(color: DVec3, curve: u32, generic: DVec3, by_luminance: bool, into_gamut: bool) -> DVec3 {
    tone_map_with(color, tone_in_rec2020(curve), |color| tone_curve(color, curve, generic), by_luminance, into_gamut)
}

/// Tone maps with any curve, in Rec.2020 if `wide`, otherwise in Rec.709. CPU only.
pub fn tone_map_with(
    color: DVec3,
    wide: bool,
    curve: impl Fn(DVec3) -> DVec3,
    by_luminance: bool,
    into_gamut: bool,
) -> DVec3 {
    let own = if wide { rec2020_from_rec709(color) } else { color };
    let shown = if by_luminance {
        let weights = if wide { LUMINANCE_REC2020 } else { LUMINANCE_REC709 };
        let positive = own.clamp(DVec3::ZERO, DVec3::splat(65504.0));
        scale_luminance(positive, weights, curve(DVec3::splat(positive.dot(weights))).y)
    } else {
        curve(own)
    };
    let shown = if wide { rec709_from_rec2020(shown) } else { shown };
    let shown = if into_gamut { map_into_gamut(shown) } else { shown };
    shown.clamp(DVec3::ZERO, DVec3::ONE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::layout::GenericCurve;
    use crate::reference::srgb::srgb_from_linear;

    fn shown(color: DVec3, curve: u32) -> DVec3 {
        tone_map(color, curve, GenericCurve::DEFAULT.numbers(), false, false)
    }

    #[test]
    fn greys_rise_monotonically_from_black_to_white() {
        // All curves except false colors.
        for curve in (0..12).chain([13]) {
            let grey = |x: f64| shown(DVec3::splat(x), curve);
            let mut last = grey(0.0);
            assert!(last.max_element() <= 1e-3, "curve {curve}: black is {last}");
            for i in 0..4000 {
                let now = grey(1e-4 * 1.004_f64.powi(i));
                // The polynomial of AgX dips near black; its golden look reduces blue as red increases.
                let rise = (now - last).dot(LUMINANCE_REC709);
                assert!(rise > -1e-5, "curve {curve}: {last} then {now}");
                last = now;
            }
            // The golden look is darker than white.
            let white = [0.98, 0.9, 0.7][usize::from(tone_in_rec2020(curve)) + usize::from(curve == 8)];
            assert!(last.dot(LUMINANCE_REC709) > white, "curve {curve}: white is {last}");
        }
    }

    /// Hard case 47: every curve stays in 0…1 for any input.
    #[test]
    fn hard_case_47_hard_inputs_stay_in_range() {
        for (curve, luminance, gamut) in (0..14).flat_map(|c| [(c, false, false), (c, true, false), (c, false, true)]) {
            for x in [-0.2, -1e9, 0.0, 160.0, 161.6, 65504.0, 1e19, 1.2e19] {
                for color in [DVec3::splat(x), DVec3::new(x, 0.0, 0.0), DVec3::new(0.0, x, 1.0)] {
                    let c = tone_map(color, curve, GenericCurve::DEFAULT.numbers(), luminance, gamut);
                    let inside = c.cmpge(DVec3::ZERO).all() && c.cmple(DVec3::ONE).all();
                    assert!(inside, "curve {curve} of {color}: {c}");
                }
            }
        }
    }

    #[test]
    fn known_values() {
        let grey = tone_map_hill(DVec3::splat(0.18));
        assert!((grey.x - 0.1056).abs() < 5e-4, "ACES renders 18 % to 10.4 %: {grey}");
        let filmic = tone_map_filmic(DVec3::splat(0.18)).x;
        assert!((filmic - 0.2669).abs() < 5e-4, "{filmic}");
        // 0.18 / 0.335 · 1.019: three 8-bit steps below the curve that it fits, encoded.
        let mobile = tone_map_mobile(DVec3::splat(0.18)).x;
        assert!((mobile - 0.547_522).abs() < 1e-6, "{mobile}");
        let encoded = srgb_from_linear(tone_map_filmic(DVec3::splat(0.18))).x;
        assert!((mobile - encoded).abs() < 4.0 / 255.0 && (mobile - filmic).abs() > 0.2, "{encoded}");
        assert!((srgb_from_linear(shown(DVec3::splat(0.18), 13)).x - mobile).abs() < 1e-9, "encoded once, not twice");
        let base = DVec3::new(0.5, 0.3, 0.2);
        assert!(shown(base, 5).abs_diff_eq(base, 1e-9), "within the gamut nothing changes");
        // Pure red of 7 is (1, 0.48, 0.11) in Rec.2020.
        let red = shown(DVec3::new(7.0, 0.0, 0.0), 5);
        assert!(red.abs_diff_eq(DVec3::new(1.0, 0.4224, 0.0615), 1e-3), "{red}");
        assert_eq!(tone_map_neutral(base), base - 0.04, "only the Fresnel offset is removed");
    }

    /// Verifies that tone mapping by luminance gives the curve's luminance and keeps the hue.
    #[test]
    fn by_luminance_a_bright_red_stays_red() {
        let red = DVec3::new(8.0, 0.4, 0.2);
        let (kept, cut) = (tone_map(red, 2, DVec3::ZERO, true, false), tone_map(red, 2, DVec3::ZERO, false, false));
        let expected = tone_map_filmic(DVec3::splat(red.dot(LUMINANCE_REC709))).x;
        assert!((kept.dot(LUMINANCE_REC709) - expected).abs() < 1e-9, "{kept}");
        assert!((cut.dot(LUMINANCE_REC709) - expected).abs() > 0.01, "{cut}");
    }
}
