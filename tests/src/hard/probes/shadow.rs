//! Shadow maps.

use super::{COMPONENT, Domain, Probe, SHARE, Values, both, bounded, in_half, is_any, is_share};

/// Stored depths, and values outside 0…1 (row 43).
const DEPTH: Domain = Values(&[-0.1, 0.0, 1e-7, 0.5, 0.9999, 1.0, 1.1]);

pub(super) const PROBES: &[Probe] = &[
    // An edge-on receiver: its slope counts as zero.
    bounded(42, "receiver_plane_slope", &[COMPONENT, COMPONENT, COMPONENT, COMPONENT, COMPONENT, COMPONENT], |_, y| {
        y.iter().all(|slope| slope.abs() < 1e6)
    }),
    bounded(
        42,
        "receiver_plane_slope",
        &[Values(&[0.0, 1e-20]), Values(&[0.0]), SHARE, Values(&[0.0, 1e-20]), Values(&[0.0]), SHARE],
        is_any,
    ),
    both(43, "penumbra_ratio_parallel", &[SHARE, DEPTH], |_, y| (0.0..=11_001.0).contains(&y[0])),
    both(43, "penumbra_ratio_perspective", &[SHARE, SHARE, Values(&[0.0, 1e-7, 0.1])], |_, y| y[0] >= 0.0),
    both(43, "micro_shadowing", &[Values(&[-1.0, 0.0, 1e-4, 1.0]), Values(&[0.0, 0.9999, 1.0, 1.001])], is_share),
    both(43, "faded_visibility", &[SHARE, Values(&[0.0, 1e6]), Values(&[0.0, 1e-4, 1.0])], |_, y| {
        (-1e-6..=1.000_001).contains(&y[0])
    }),
    // Strengths of none and all.
    both(43, "weakened_visibility", &[SHARE, SHARE], |x, y| is_share(x, y) && (x[1] != 1.0 || y[0] == x[0])),
    both(44, "warp_depth", &[DEPTH], |_, y| (0.003..=255.0).contains(&y[0])),
    both(44, "depth_moments", &[DEPTH, Values(&[-1e6, 0.0, 1e6]), Values(&[0.0, 1e6])], in_half),
    both(45, "moment_visibility", &[SHARE, SHARE, SHARE, Values(&[1e-6, 1e-3]), Values(&[0.0, 0.2, 0.9])], is_share),
    // A receiver seen along the edge of a texel would have unlimited variance.
    both(
        45,
        "least_variance",
        &[Values(&[0.0039, 254.0]), Values(&[1e-3]), Values(&[0.0, 1e6]), Values(&[0.0, 1e6])],
        |x, y| y[0] >= 0.0 && y[0] <= x[0] * x[0] * (1e-3 + 0.35),
    ),
    // Ties select the first axis, and the zero vector selects a face.
    both(46, "cube_face_of", &[COMPONENT, COMPONENT, COMPONENT], |x, y| {
        let a = [x[0].abs(), x[1].abs(), x[2].abs()];
        let axis = if a[0] >= a[1] && a[0] >= a[2] {
            0
        } else if a[1] >= a[2] {
            1
        } else {
            2
        };
        y[0] == (2 * axis + usize::from(x[axis] < 0.0)) as f32
    }),
];
