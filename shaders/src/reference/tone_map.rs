//! Mirror of `wgsl/lib/tone_map.wgsl`.

use glam::{DMat3, DVec3};

/// Cut off at one.
pub fn tone_map_linear(color: DVec3) -> DVec3 {
    color.clamp(DVec3::ZERO, DVec3::ONE)
}

fn input(color: DVec3) -> DVec3 {
    color.clamp(DVec3::ZERO, DVec3::splat(100.0))
}

/// Cut off at one in the primaries of Rec.2020.
pub fn tone_map_linear_2020(color: DVec3) -> DVec3 {
    // The rows below are rows of the matrices, hence the transposes.
    let into = DMat3::from_cols_array_2d(&[
        [0.627_404, 0.329_283, 0.043_313],
        [0.069_097, 0.919_540, 0.011_362],
        [0.016_391, 0.088_013, 0.895_595],
    ]);
    let out_of = DMat3::from_cols_array_2d(&[
        [1.660_491, -0.587_641, -0.072_850],
        [-0.124_550, 1.132_900, -0.008_349],
        [-0.018_151, -0.100_579, 1.118_730],
    ]);
    let wide = (into.transpose() * input(color)).clamp(DVec3::ZERO, DVec3::ONE);
    (out_of.transpose() * wide).clamp(DVec3::ZERO, DVec3::ONE)
}

/// ACES 1.0 as fitted by Hill.
pub fn tone_map_aces(color: DVec3) -> DVec3 {
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

/// The same, brighter by 1/0.6.
pub fn tone_map_aces_legacy(color: DVec3) -> DVec3 {
    tone_map_aces(color / 0.6)
}

/// Narkowicz' per-channel curve.
pub fn tone_map_filmic(color: DVec3) -> DVec3 {
    let c = input(color);
    ((c * (2.51 * c + 0.03)) / (c * (2.43 * c + 0.59) + 0.14)).clamp(DVec3::ZERO, DVec3::ONE)
}

/// Khronos PBR Neutral.
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

/// The curve of the given number; an unknown number is linear.
pub fn tone_map(color: DVec3, curve: u32) -> DVec3 {
    match curve {
        1 => tone_map_aces(color),
        2 => tone_map_filmic(color),
        3 => tone_map_neutral(color),
        4 => tone_map_aces_legacy(color),
        5 => tone_map_linear_2020(color),
        _ => tone_map_linear(color),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn greys_rise_monotonically_from_black_to_white() {
        for curve in 0..6 {
            let grey = |x: f64| tone_map(DVec3::splat(x), curve);
            let mut last = grey(0.0);
            assert!(last.max_element() <= 1e-3, "curve {curve}: black is {last}");
            for i in 0..4000 {
                let now = grey(1e-4 * 1.004_f64.powi(i));
                assert!(now.cmpge(last - 1e-12).all(), "curve {curve}: {last} then {now}");
                last = now;
            }
            assert!(last.min_element() > 0.98, "curve {curve}: white is {last}");
        }
    }

    #[test]
    fn hard_inputs_stay_in_range() {
        for curve in 0..6 {
            for x in [-0.2, -1e9, 0.0, 160.0, 161.6, 65504.0, 1e19, 1.2e19, f64::INFINITY] {
                for color in [DVec3::splat(x), DVec3::new(x, 0.0, 0.0), DVec3::new(0.0, x, 1.0)] {
                    let c = tone_map(color, curve);
                    let inside = c.cmpge(DVec3::ZERO).all() && c.cmple(DVec3::ONE).all();
                    assert!(inside, "curve {curve} of {color}: {c}");
                }
            }
        }
    }

    #[test]
    fn known_values() {
        let grey = tone_map_aces(DVec3::splat(0.18));
        assert!((grey.x - 0.1056).abs() < 5e-4, "ACES renders 18 % to 10.4 %: {grey}");
        let filmic = tone_map_filmic(DVec3::splat(0.18)).x;
        assert!((filmic - 0.2669).abs() < 5e-4, "{filmic}");
        let base = DVec3::new(0.5, 0.3, 0.2);
        assert!(tone_map_linear_2020(base).abs_diff_eq(base, 2e-6), "within the gamut nothing changes");
        // 7 of pure red: (1, 0.48, 0.11) of Rec.2020.
        let red = tone_map_linear_2020(DVec3::new(7.0, 0.0, 0.0));
        assert!(red.abs_diff_eq(DVec3::new(1.0, 0.4224, 0.0615), 1e-3), "{red}");
        assert_eq!(tone_map_neutral(base), base - 0.04, "only the Fresnel offset is removed");
    }
}
