//! Mirror of `wgsl/lib/grading.wgsl`, and the white balance that the CPU works out.

use glam::{DMat3, DVec3};

use super::luminance::luminance;

/// LogC of 18 % grey.
pub const LOG_C_GREY: f64 = 0.391_007_03;

/// LogC from linear light.
pub fn log_c_from_linear(color: DVec3) -> DVec3 {
    let log_c = |x: f64| 0.244_161 * (5.555_556 * x.max(0.0) + 0.047_996).log10() + 0.386_036;
    DVec3::from_array(color.to_array().map(log_c))
}

/// Linear light from LogC.
pub fn linear_from_log_c(log_c: DVec3) -> DVec3 {
    let linear = |y: f64| ((10.0_f64.powf((y - 0.386_036) / 0.244_161) - 0.047_996) / 5.555_556).max(0.0);
    DVec3::from_array(log_c.to_array().map(linear))
}

/// x to the power p, and 0 for x ≤ 0.
pub fn positive_power(x: f64, p: f64) -> f64 {
    if x <= 0.0 { 0.0 } else { x.powf(p) }
}

/// (color · slope + offset)^power.
pub fn slope_offset_power(color: DVec3, slope: DVec3, offset: DVec3, power: DVec3) -> DVec3 {
    let base = (color * slope + offset).to_array();
    DVec3::from_array(std::array::from_fn(|c| positive_power(base[c], power[c])))
}

/// Distances from `pivot` times `amount`.
pub fn contrast_about(color: DVec3, pivot: f64, amount: f64) -> DVec3 {
    (color - pivot) * amount + pivot
}

/// Distances from the grey of equal luminance times `amount`.
pub fn saturation(color: DVec3, amount: f64) -> DVec3 {
    let grey = DVec3::splat(luminance(color));
    grey + (color - grey) * amount
}

/// Saturation that spares reds.
pub fn vibrance(color: DVec3, amount: f64) -> DVec3 {
    let red = (color.x - color.y.max(color.z)).clamp(-20.0, 20.0);
    saturation(color, 1.0 + (amount - 1.0) / (1.0 + (3.0 * red).exp()))
}

/// XYZ from linear Rec.709 (ITU-R BT.709-6, white D65).
const XYZ_FROM_REC709: DMat3 = DMat3::from_cols(
    DVec3::new(0.412_390_8, 0.212_639_0, 0.019_330_8),
    DVec3::new(0.357_584_3, 0.715_168_7, 0.119_194_8),
    DVec3::new(0.180_480_8, 0.072_192_3, 0.950_532_2),
);

/// Cone responses from XYZ by CAT16 (Li et al., "Comprehensive color solutions", 2017).
const CAT16_FROM_XYZ: DMat3 = DMat3::from_cols(
    DVec3::new(0.401_288, -0.250_268, -0.002_079),
    DVec3::new(0.650_173, 1.204_414, 0.048_952),
    DVec3::new(-0.051_461, 0.045_854, 0.953_127),
);

/// Adapts linear Rec.709 light to another white. `temperature` and `tint` go from -1 to 1: colder or warmer along the
/// daylight locus (CIE 15), greener or more magenta across it; beyond they are clamped. CPU only.
pub fn white_balance(temperature: f64, tint: f64) -> DMat3 {
    let (temperature, tint) = (temperature.clamp(-1.0, 1.0), tint.clamp(-1.0, 1.0));
    let daylight = |x: f64| -3.0 * x * x + 2.87 * x - 0.275;
    let cones = |x: f64, y: f64| CAT16_FROM_XYZ * (DVec3::new(x, y, 1.0 - x - y) / y);
    // Blue light lies closer to white in chromaticity than red light of the same difference to the eye.
    let x = 0.312_71 - temperature * if temperature < 0.0 { 0.1 } else { 0.05 };
    let (from, to) = (cones(x, daylight(x) + tint * 0.05), cones(0.312_71, daylight(0.312_71)));
    let adapt = CAT16_FROM_XYZ * XYZ_FROM_REC709;
    adapt.inverse() * DMat3::from_diagonal(to / from) * adapt
}

#[cfg(test)]
mod tests {
    use super::*;

    const COLORS: [DVec3; 4] = [
        DVec3::new(0.18, 0.18, 0.18),
        DVec3::new(3.0, 0.2, 0.01),
        DVec3::new(0.0, 0.5, 8.0),
        DVec3::new(60.0, 1.0, 9.0),
    ];

    #[test]
    fn neutral_settings_change_nothing() {
        for color in COLORS {
            let log_c = log_c_from_linear(color);
            assert!((linear_from_log_c(log_c) - color).abs().max_element() < 1e-9 * color.max_element(), "{color}");
            let decided = slope_offset_power(log_c, DVec3::ONE, DVec3::ZERO, DVec3::ONE);
            assert!((contrast_about(decided, LOG_C_GREY, 1.0) - log_c).length() < 1e-12);
            assert!((saturation(vibrance(color, 1.0), 1.0) - color).length() < 1e-12);
            assert!((white_balance(0.0, 0.0) * color - color).length() < 1e-9 * color.length());
        }
    }

    #[test]
    fn the_logarithm_is_arris() {
        assert!((log_c_from_linear(DVec3::splat(0.18)).x - LOG_C_GREY).abs() < 1e-6);
        assert!(log_c_from_linear(DVec3::splat(-1.0)).x > 0.06, "black is above zero");
        assert_eq!(linear_from_log_c(DVec3::splat(-1.0)), DVec3::ZERO);
    }

    #[test]
    fn saturation_keeps_luminance_and_vibrance_spares_reds() {
        for color in COLORS {
            for amount in [0.0, 0.5, 2.0] {
                for graded in [saturation(color, amount), vibrance(color, amount)] {
                    assert!((luminance(graded) - luminance(color)).abs() < 1e-12 * (1.0 + color.length()));
                }
            }
        }
        let change = |color: DVec3| (vibrance(color, 2.0) - color).length() / (saturation(color, 2.0) - color).length();
        assert!(change(DVec3::new(3.0, 0.2, 0.1)) < 0.01 && change(DVec3::new(0.1, 0.2, 3.0)) > 0.99);
    }

    #[test]
    fn a_warmer_balance_is_redder_and_greens_turn_magenta() {
        let white = |temperature, tint| white_balance(temperature, tint) * DVec3::ONE;
        let (cold, warm, magenta) = (white(-1.0, 0.0), white(1.0, 0.0), white(0.0, 1.0));
        assert!(warm.x > 1.05 && warm.z < 0.95, "{warm}");
        assert!(cold.x < 0.95 && cold.z > 1.05, "{cold}");
        assert!(magenta.y < magenta.x && magenta.y < magenta.z, "{magenta}");
        assert_eq!(white(5.0, 0.0), warm, "clamped");
    }

    #[test]
    fn decisions_do_what_they_say() {
        let color = DVec3::new(0.5, 0.25, 0.0);
        let half = slope_offset_power(color, DVec3::splat(0.5), DVec3::splat(-0.2), DVec3::splat(2.0));
        assert!((half - DVec3::new(0.0025, 0.0, 0.0)).length() < 1e-12, "{half}");
        assert_eq!(contrast_about(color, 0.25, 2.0), DVec3::new(0.75, 0.25, -0.25));
    }
}
