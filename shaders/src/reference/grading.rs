//! Mirror of `wgsl/lib/grading.wgsl`, and the white balance that the CPU computes.

use super::primaries::{XYZ_FROM_REC2020, rows};
use glam::{DMat3, DVec3};

/// LogC value that contrast leaves unchanged: 18 % gray in ACEScct.
pub const CONTRAST_PIVOT: f64 = 0.413_588_4;

/// Converts linear light to LogC.
pub fn log_c_from_linear(color: DVec3) -> DVec3 {
    let log_c = |x: f64| 0.244_161 * (5.555_556 * x.clamp(0.0, 1e30) + 0.047_996).log10() + 0.386_036;
    DVec3::from_array(color.to_array().map(log_c))
}

/// Converts LogC to linear light.
pub fn linear_from_log_c(log_c: DVec3) -> DVec3 {
    // Same maximum exponent as in the shader.
    let power = |y: f64| 10.0_f64.powf(((y - 0.386_036) / 0.244_161).min(60.0 * 2.0_f64.log10()));
    let linear = |y: f64| (power(y) - 0.047_996) / 5.555_556;
    DVec3::from_array(log_c.to_array().map(linear))
}

/// Returns the weights of shadows, midtones and highlights.
pub fn tonal_shares(y: f64, ranges: [f64; 4]) -> DVec3 {
    let step = |low: f64, high: f64| {
        let t = ((y - low) / (high - low)).clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    };
    let (shadows, highlights) = (1.0 - step(ranges[0], ranges[1]), step(ranges[2], ranges[3]));
    DVec3::new(shadows, 1.0 - shadows - highlights, highlights)
}

/// Returns x to the power p for x > 0, and x itself otherwise.
pub fn positive_power(x: f64, p: f64) -> f64 {
    if x <= 0.0 { x } else { x.powf(p) }
}

/// Returns (color · slope + offset)^power.
pub fn slope_offset_power(color: DVec3, slope: DVec3, offset: DVec3, power: DVec3) -> DVec3 {
    let base = (color * slope + offset).to_array();
    DVec3::from_array(std::array::from_fn(|c| positive_power(base[c], power[c])))
}

/// Scales the distance from `pivot` by `amount`.
pub fn contrast_about(color: DVec3, pivot: f64, amount: f64) -> DVec3 {
    (color - pivot) * amount + pivot
}

/// Scales the distance from the gray of equal luminance by `amount`.
pub fn saturation(color: DVec3, weights: DVec3, amount: f64) -> DVec3 {
    let grey = DVec3::splat(color.dot(weights));
    grey + (color - grey) * amount
}

/// Scales saturation by an amount that depends on how red a color is.
pub fn vibrance(color: DVec3, weights: DVec3, amount: f64) -> DVec3 {
    let red = (color.x - color.y.max(color.z)).clamp(-20.0, 20.0);
    saturation(color, weights, 1.0 + (amount - 1.0) / (1.0 + (-3.0 * red).exp()))
}

/// Evaluates a power below the middle and a line above.
pub fn toe_and_shoulder(x: f64, gamma: f64, middle: f64, scale: f64) -> f64 {
    if x <= middle { positive_power(x, gamma) / middle.powf(gamma - 1.0) } else { scale * (x - middle) + middle }
}

/// Changes the luminance of a color at constant hue.
pub fn scale_luminance(color: DVec3, weights: DVec3, luminance_out: f64) -> DVec3 {
    let peak = color.max_element();
    if peak <= 1e-10 {
        return DVec3::splat(luminance_out);
    }
    let ratio = (color / peak).max(DVec3::ZERO);
    let (luminance, reserves) = (ratio.dot(weights), DVec3::ONE - ratio);
    let missing = (luminance_out - luminance).max(0.0);
    let added = missing / reserves.dot(weights).max(1e-30);
    ratio * ((luminance_out - missing) / luminance.max(1e-30)) + reserves * added
}

/// Cone responses from XYZ with CAT16 (Li et al., "Comprehensive color solutions", 2017).
const CAT16_FROM_XYZ: DMat3 =
    rows([0.401_288, 0.650_173, -0.051_461], [-0.250_268, 1.204_414, 0.045_854], [-0.002_079, 0.048_952, 0.953_127]);

/// Returns the matrix that adapts linear Rec.2020 light to another white. `temperature` and `tint` range from -1 to 1
/// and are clamped. Temperature moves from cold to warm along the daylight locus (CIE 15), tint from green to magenta
/// across it. CPU only.
pub fn white_balance(temperature: f64, tint: f64) -> DMat3 {
    let (temperature, tint) = (temperature.clamp(-1.0, 1.0), tint.clamp(-1.0, 1.0));
    let daylight = |x: f64| -3.0 * x * x + 2.87 * x - 0.275;
    let cones = |x: f64, y: f64| CAT16_FROM_XYZ * (DVec3::new(x, y, 1.0 - x - y) / y.max(1e-5));
    // For the same perceived difference, blue light is closer to white in chromaticity than red light.
    let x = 0.312_71 - temperature * if temperature < 0.0 { 0.0214 } else { 0.066 };
    let (from, to) = (cones(x, daylight(x) + tint * 0.066), cones(0.312_71, 0.329_02));
    let adapt = CAT16_FROM_XYZ * XYZ_FROM_REC2020;
    adapt.inverse() * DMat3::from_diagonal(to / from) * adapt
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::primaries::LUMINANCE_REC2020 as WEIGHTS;

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
            assert!((contrast_about(decided, CONTRAST_PIVOT, 1.0) - log_c).length() < 1e-12);
            assert!((saturation(vibrance(color, WEIGHTS, 1.0), WEIGHTS, 1.0) - color).length() < 1e-12);
            assert!((tonal_shares(color.y, [0.0, 0.333, 0.55, 1.0]).element_sum() - 1.0).abs() < 1e-12);
            for x in color.to_array() {
                assert!((toe_and_shoulder(x, 1.0, 1.0, 1.0) - x).abs() < 1e-12 * (1.0 + x));
            }
            // The daylight locus misses the D65 white point by 1e-4.
            assert!((white_balance(0.0, 0.0) * color - color).length() < 2e-3 * color.length());
        }
    }

    #[test]
    fn the_logarithm_is_arris() {
        assert!((log_c_from_linear(DVec3::splat(0.18)).x - 0.391_007_03).abs() < 1e-6);
        assert!(linear_from_log_c(DVec3::splat(-1.0)).x < 0.0, "below black");
    }

    /// Hard case 48: zero, negative and very large values in LogC.
    #[test]
    fn hard_case_48_log_c_is_finite() {
        for x in [-0.008_64, -1.0, 0.0] {
            assert!((log_c_from_linear(DVec3::splat(x)).x - 0.0640).abs() < 1e-4, "{x}");
        }
        assert!((log_c_from_linear(DVec3::splat(58.86)).x - 1.0).abs() < 1e-3, "the end of a table");
        let far = log_c_from_linear(DVec3::splat(65504.0)).x;
        assert!((1.74..1.75).contains(&far), "{far}");
    }

    #[test]
    fn saturation_keeps_luminance_and_vibrance_is_for_reds() {
        for color in COLORS {
            for amount in [0.0, 0.5, 2.0] {
                for graded in [saturation(color, WEIGHTS, amount), vibrance(color, WEIGHTS, amount)] {
                    assert!((graded - color).dot(WEIGHTS).abs() < 1e-12 * (1.0 + color.length()));
                }
            }
        }
        let change = |color: DVec3| {
            (vibrance(color, WEIGHTS, 2.0) - color).length() / (saturation(color, WEIGHTS, 2.0) - color).length()
        };
        assert!(change(DVec3::new(3.0, 0.2, 0.1)) > 0.99 && change(DVec3::new(0.1, 0.2, 3.0)) < 0.01);
    }

    #[test]
    fn a_warmer_balance_is_redder_and_greens_turn_magenta() {
        let white = |temperature, tint| white_balance(temperature, tint) * DVec3::ONE;
        let (cold, warm, magenta) = (white(-1.0, 0.0), white(1.0, 0.0), white(0.0, 1.0));
        assert!(warm.x > 1.05 && warm.z < 0.95, "{warm}");
        assert!(cold.x < 0.99 && cold.z > 1.02, "{cold}");
        assert!(magenta.y < magenta.x && magenta.y < magenta.z, "{magenta}");
        assert_eq!(white(5.0, 0.0), warm, "clamped");
    }

    #[test]
    fn decisions_do_what_they_say() {
        let color = DVec3::new(0.5, 0.25, 0.0);
        let half = slope_offset_power(color, DVec3::splat(0.5), DVec3::splat(-0.2), DVec3::splat(2.0));
        assert!((half - DVec3::new(0.0025, -0.075, -0.2)).length() < 1e-12, "{half}");
        assert_eq!(contrast_about(color, 0.25, 2.0), DVec3::new(0.75, 0.25, -0.25));
        assert_eq!(tonal_shares(0.0, [0.0, 0.3, 0.5, 1.0]), DVec3::X);
        assert_eq!(tonal_shares(2.0, [0.0, 0.3, 0.5, 1.0]), DVec3::Z);
        assert_eq!(toe_and_shoulder(2.0, 2.0, 1.0, 0.5), 1.5);
        assert_eq!(toe_and_shoulder(0.5, 2.0, 1.0, 0.5), 0.25);
    }

    #[test]
    fn scaled_luminance_is_what_was_asked_for() {
        for color in COLORS {
            for y in [0.01, 0.2, 0.7, 1.0] {
                let scaled = scale_luminance(color, WEIGHTS, y);
                assert!((scaled.dot(WEIGHTS) - y).abs() < 1e-5, "{color} {y}: {scaled}");
                assert!(scaled.min_element() > -1e-9 && scaled.max_element() < 1.0 + 1e-5, "{color} {y}: {scaled}");
            }
        }
        assert_eq!(scale_luminance(DVec3::ZERO, WEIGHTS, 0.0), DVec3::ZERO);
    }
}
