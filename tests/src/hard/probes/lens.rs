//! Fog, depth of field, flares.

use super::{Domain, ONE, Probe, Values, both, bounded, is_any, is_positive};

/// Density changes over the whole ray, falling and rising (row 53).
const DECAY: Domain = Values(&[-1e4, -200.0, -1e-6, -0.0, 0.0, 1e-6, 1e-5, 200.0, 1e4]);

pub(super) const PROBES: &[Probe] = &[
    bounded(53, "mean_decay", &[DECAY], is_positive),
    bounded(
        53,
        "fog_optical_depth",
        &[Values(&[0.0, 0.01, 10.0]), DECAY, Values(&[0.0, 7.0]), Values(&[0.0, 7.0, 1e6]), Values(&[0.0, 1.0])],
        |x, y| y[0] >= 0.0 && (x[0] > 0.0 || y[0] == 0.0),
    ),
    // A circle of confusion near 0 becomes 0; infinite distance has a finite circle.
    both(
        54,
        "coc_radius",
        &[Values(&[0.9999, 1.0001]), ONE, Values(&[1000.0]), Values(&[32.0]), Values(&[8.0])],
        |_, y| y[0] == 0.0,
    ),
    bounded(
        54,
        "coc_radius",
        &[Values(&[0.0, 1.0, 1e30]), Values(&[0.05, 1e6]), Values(&[0.0, 1e6, 1e30]), Values(&[32.0]), Values(&[8.0])],
        |x, y| (-x[3]..=x[4]).contains(&y[0]),
    ),
    // The center of the picture has no radial direction.
    bounded(8, "flare_direction", &[Values(&[0.5001]), Values(&[0.5001]), Values(&[1.0])], |_, y| y == [0.0; 2]),
    bounded(8, "starburst", &[Values(&[0.5001]), Values(&[0.5001]), Values(&[0.0])], is_any),
];
