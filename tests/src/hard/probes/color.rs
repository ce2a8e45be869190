//! Tone curves, grading, transfer functions.

use super::{Domain, Probe, RADIANCE, SHARE, Values, both, is_any, is_positive, is_share};
use Domain::Count;

/// Values around the end of a curve (row 49).
const CODE: Domain = Values(&[-1e9, -1e-3, -0.0, 0.0, 1e-6, 0.0031308, 0.04045, 1.0, 1.0001, 1e9, f64::NAN]);

pub(super) const PROBES: &[Probe] = &[
    both(47, "tone_map", &[RADIANCE, RADIANCE, RADIANCE, Count(14), Values(&[0.0, 1.0])], is_share),
    both(47, "tone_map_hill", &[RADIANCE, RADIANCE, RADIANCE], is_share),
    both(47, "tone_map_filmic", &[RADIANCE, RADIANCE, RADIANCE], is_share),
    both(47, "tone_map_mobile", &[RADIANCE, RADIANCE, RADIANCE], is_share),
    both(47, "tone_map_neutral", &[RADIANCE, RADIANCE, RADIANCE], is_share),
    both(
        47,
        "tone_generic",
        &[RADIANCE, RADIANCE, RADIANCE, Values(&[1.55]), Values(&[0.26]), Values(&[1.01])],
        |_, y| y.iter().all(|y| (0.0..=1.02).contains(y)),
    ),
    both(47, "tone_aces", &[RADIANCE, RADIANCE, RADIANCE, Values(&[1.0, 1.0 / 0.6])], |_, y| {
        y.iter().all(|y| y.abs() < 2.0)
    }),
    both(47, "aces_saturation", &[SHARE, SHARE, SHARE], is_share),
    both(47, "aces_glow", &[SHARE, SHARE, SHARE, SHARE], |_, y| (0.0..=0.0501).contains(&y[0])),
    both(47, "aces_redness", &[SHARE, SHARE, SHARE], |x, y| {
        let grey = x.iter().all(|c| *c == x[0]);
        if grey { y[0] == 0.0 } else { is_share(x, y) }
    }),
    both(47, "tone_agx", &[RADIANCE, RADIANCE, RADIANCE, Count(3)], |_, y| y.iter().all(|y| (0.0..2.0).contains(y))),
    both(47, "tone_gt7", &[RADIANCE, RADIANCE, RADIANCE], |_, y| y.iter().all(|y| y.abs() < 2.0)),
    both(47, "gt7_curve", &[Values(&[-1.0, -0.0, 0.0, 1e-30, 1.11, 100.0])], |_, y| (-1.0..3.0).contains(&y[0])),
    both(47, "pq_from_nits", &[Values(&[-1.0, -0.0, 0.0, 1e-30, 10_000.0, 1e6]), SHARE, SHARE], |_, y| {
        y.iter().all(|y| (0.0..2.0).contains(y))
    }),
    both(47, "nits_from_pq", &[Values(&[-1.0, -0.0, 0.0, 0.5, 1.0, 1.1]), SHARE, SHARE], |_, y| {
        y.iter().all(|y| (0.0..=10_100.0).contains(y))
    }),
    both(47, "tone_display_range", &[RADIANCE, RADIANCE, RADIANCE], is_share),
    both(47, "map_into_gamut", &[Values(&[-1.0, 0.0, 1.0, 10.0]), Values(&[-1.0, 0.0, 1.0, 10.0]), SHARE], |_, y| {
        y.iter().all(|y| (-0.04..=1.04).contains(y))
    }),
    // Colors inside the gamut are unchanged.
    both(47, "map_into_gamut", &[SHARE, SHARE, SHARE], |x, y| x.iter().zip(y).all(|(x, y)| x.to_bits() == y.to_bits())),
    both(47, "oklab_from_rec709", &[Values(&[-1.0, -0.0, 0.0, 1e-30]), Values(&[-1.0, 0.0]), SHARE], is_any),
    both(
        47,
        "scale_luminance",
        &[Values(&[0.0, -0.0, 1e-30, 1e-11, 1.0, 65504.0]), Values(&[-1.0, 0.0, 1.0]), SHARE, SHARE],
        is_positive,
    ),
    both(47, "night_adaptation", &[Values(&[-1.0, 0.0, 65504.0]), SHARE, SHARE, SHARE], is_any),
    both(
        48,
        "log_c_from_linear",
        &[Values(&[-1.0, -0.00864, 0.0, 58.86, 65504.0, 1e38]), RADIANCE, RADIANCE],
        |_, y| y.iter().all(|y| (0.063..=10.0).contains(y)),
    ),
    both(48, "linear_from_log_c", &[Values(&[-1.0, 0.0, 1.0, 1.744, 1e6]), SHARE, SHARE], is_any),
    both(48, "table_coordinates", &[RADIANCE, RADIANCE, RADIANCE, Values(&[16.0, 64.0])], |x, y| {
        y.iter().all(|at| (0.5 / x[3] - 1e-6..=1.0 - 0.5 / x[3] + 1e-6).contains(at))
    }),
    both(49, "srgb_from_linear_channel", &[CODE], is_share),
    both(49, "linear_from_srgb_channel", &[CODE], is_share),
    both(49, "srgb_from_linear", &[CODE, CODE, CODE], is_share),
    both(49, "linear_from_srgb", &[CODE, CODE, CODE], is_share),
    both(49, "positive_power", &[Values(&[-1e9, -1e-3, -0.0, 0.0, 1e-30, 1.0]), Values(&[0.2, 1.0, 3.0])], is_any),
    both(
        49,
        "toe_and_shoulder",
        &[Values(&[-1.0, 0.0, 1e-30, 1.0]), Values(&[0.3, 3.0]), Values(&[0.2]), Values(&[1.0])],
        is_any,
    ),
    both(
        49,
        "vibrance",
        &[Values(&[-1e3, 0.0, 1e3]), SHARE, SHARE, Values(&[0.3]), Values(&[0.3]), Values(&[0.3]), SHARE],
        is_any,
    ),
];
