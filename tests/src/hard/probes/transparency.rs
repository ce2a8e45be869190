//! Probes of order-independent transparency.

use super::{MOST, NONE, Probe, Values, both, bounded, in_half, is_share};

/// Warped distances: both ends, nearly the middle.
const AT: super::Domain = Values(&[-1.0, -1e-6, 0.3, 1.0]);
/// Absorbances: none, too little to count, some, what hides everything.
const ABSORBED: super::Domain = Values(&[0.0, 4e-4, 0.7, 10.0]);
const CHANNEL: super::Domain = Values(&[0.0, 1.0, 65504.0]);

pub(super) const PROBES: &[Probe] = &[
    both(58, "absorbance", &[Values(&[0.0, 0.5, 1.0, 1.000_000_2])], |_, y| (0.0..=10.0).contains(&y[0])),
    both(58, "transmittance_of", &[Values(&[-1.0, 0.0, 0.5, 9.999, 10.0, 640.0, 65504.0])], |x, y| {
        is_share(x, y) && (x[0] < 10.0 || y[0] == 0.0)
    }),
    both(58, "warped_distance", &[Values(&[-1.0, 0.0, 1e-30, 1.0, 1e30]), Values(&[0.05, 2000.0]), NONE], |_, y| {
        (-1.0..=1.0).contains(&y[0])
    }),
    both(58, "divisor", &[Values(&[0.0, -0.0, 1e-30, -1e-30, 1.0]), Values(&[1e-6])], |_, y| y[0].abs() >= 9e-7),
    bounded(58, "moment_transmittance", &[AT, AT, AT, ABSORBED, ABSORBED, ABSORBED, AT], is_share),
    both(58, "blend_weight", &[Values(&[-1.0, 0.0, 1e-3, 200.0, 1e9, 1e30])], |_, y| (3e-4..=94.0).contains(&y[0])),
    both(
        58,
        "weighted_color",
        &[CHANNEL, CHANNEL, CHANNEL, Values(&[0.0, 6e-8, 0.5, 1.0]), Values(&[0.0, 5.0, 1e30])],
        |x, y| in_half(x, y) && y[..3].iter().all(|c| 8.0 * c <= MOST),
    ),
];
