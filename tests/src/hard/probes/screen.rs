//! Screen-space effects: ambient occlusion, reflections, contact shadows.

use super::{COMPONENT, Domain, NONE, ONE, Probe, SHARE, Values, both, is_any, is_share};
use Domain::{Direction, Vector};
use std::f64::consts::FRAC_PI_2;

/// Cosines that rounding moved beyond 1 (row 35).
const BEYOND: Domain = Values(&[-1.001, -1.000_000_1, -1.0, 0.0, 1.0, 1.000_000_1, 1.001, 2.0]);
/// Albedos outside 0…1 (row 29).
const ALBEDO: Domain = Values(&[-0.5, 0.0, 0.5, 1.0, 2.0, 4.0]);

pub(super) const PROBES: &[Probe] = &[
    both(29, "gtao_multi_bounce", &[Values(&[-0.1, 0.0, 0.5, 1.0, 1.1]), ALBEDO, ALBEDO, ALBEDO], |x, y| {
        y.iter().all(|v| (x[0].clamp(0.0, 1.0)..=1.0).contains(v))
    }),
    both(
        29,
        "specular_occlusion",
        &[Values(&[-1.0, 0.0, 1e-4, 1.0]), Values(&[-0.5, 0.0, 0.5, 1.0, 1.5]), SHARE],
        is_share,
    ),
    both(35, "spherical_caps_overlap", &[BEYOND, BEYOND, BEYOND], is_any),
    both(35, "specular_occlusion_cones", &[Direction, Direction, Values(&[-0.1, 0.0, 1.0, 1.1]), SHARE], is_share),
    both(35, "horizon_occlusion", &[COMPONENT, NONE, COMPONENT, COMPONENT, NONE, COMPONENT], is_share),
    // Zero depth, radius and distance.
    both(
        32,
        "sao_term",
        &[Direction, Values(&[0.0, 1e-30, 1e-4, 0.3, 1e6]), Direction, Values(&[0.0, 0.01, 1.0]), Values(&[0.0, 0.1])],
        |_, y| (0.0..=6.0).contains(&y[0]),
    ),
    // Points slightly above the plane belong to the surface itself.
    both(
        33,
        "sao_term",
        &[ONE, NONE, NONE, Values(&[0.1]), Values(&[0.2, 0.5]), NONE, ONE, NONE, Values(&[0.1])],
        |x, y| (y[0] == 0.0) == (x[4] < 0.3),
    ),
    both(32, "sao_obscurance", &[Values(&[-1.0, -0.0, 0.0, 10.0]), Values(&[0.0, 1.0, 10.0])], is_share),
    both(35, "acos_held", &[BEYOND], |_, y| (-1e-6..=3.1417).contains(&y[0])),
    both(35, "slice_share", &[Values(&[-10.0, -1.6, 0.0, 1.6, 10.0]), Values(&[-FRAC_PI_2, 0.0, FRAC_PI_2])], is_share),
    both(31, "pyramid_level", &[Values(&[-1e9, 0.0, 1e-38, 1e9, 1e30]), Values(&[0.0, 7.0])], |x, y| {
        (0.0..=x[1]).contains(&y[0])
    }),
    both(
        35,
        "sector_bits",
        &[Values(&[-1e9, 0.0, 1.0, 1e9]), Values(&[-1e9, 0.0, 1.0, 1e9]), Values(&[0.0, 0.99])],
        |_, y| y.iter().all(|half| (0.0..=65535.0).contains(half)),
    ),
    both(
        31,
        "cone_slice",
        &[
            Values(&[1e-6, 5.0]),
            Values(&[1e-6, 5.0]),
            Values(&[0.0, 0.1]),
            Values(&[-1.1, -1.0, 0.0, 1.000_000_1]),
            Values(&[0.0]),
            Values(&[1.0]),
        ],
        is_share,
    ),
    both(33, "bilateral_weight", &[Values(&[-1e6, 0.0, 0.1, 1e6]), Values(&[0.01])], is_share),
    // Rays that start at or behind the eye plane, or run parallel to it.
    both(
        31,
        "ray_length_m",
        &[
            Values(&[-10.0, -0.1, 0.0, 1.0]),
            Values(&[-1.0, 0.0, -0.0, 1e-12, 1.0]),
            Values(&[-0.1]),
            Values(&[0.0, 10.0]),
        ],
        |x, y| (0.0..=x[3] * 1.001).contains(&y[0]),
    ),
    both(
        36,
        "share_in_picture",
        &[
            Values(&[-0.64, 0.0, 32.0, 64.0, 64.64]),
            Values(&[-0.64, 0.0, 64.0, 64.64]),
            Values(&[0.0, -0.0, 1e-30, -5.0, 1e6]),
            Values(&[0.0, -1e6, 5.0]),
        ],
        |x, y| {
            let outside = x[..2].iter().any(|at| !(0.0..=64.0).contains(at));
            if outside { y[0] == 0.0 } else { (0.0..=1.0).contains(&y[0]) }
        },
    ),
    both(36, "contact_fade", &[Values(&[-0.01, 0.0, 0.5, 1.01, 1e6]), Values(&[-0.01, 0.5, 1.01])], |x, y| {
        let outside = x.iter().any(|at| !(0.0..=1.0).contains(at));
        if outside { y[0] == 0.0 } else { (0.0..=1.0).contains(&y[0]) }
    }),
    both(30, "share_at_depth", &[SHARE, SHARE, Values(&[0.0, -0.0, 1e-38, 1e-31]), Values(&[0.1]), ONE], |x, y| {
        (x[3]..=x[4]).contains(&y[0])
    }),
    both(30, "roughness_fade", &[Values(&[0.0, 1.0]), Values(&[0.0, 1e-12, 0.5])], is_share),
    both(30, "reach_fade", &[Values(&[-1e30, 0.0, 1.0, 1e30])], is_share),
    // Points in the eye plane and behind it.
    both(
        30,
        "ndc_from_view",
        &[
            COMPONENT,
            COMPONENT,
            Values(&[0.0, 1e-12, 1.0]),
            Values(&[0.1]),
            Vector(2, 1.0, 2.0),
            Vector(2, 0.0, 0.1),
            Vector(2, 0.0, 0.1),
        ],
        is_any,
    ),
];
