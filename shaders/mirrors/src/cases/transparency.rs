//! Cases of the functions that blend surfaces in any order.

use super::super::{moment_transparency, weighted_blending};
use super::case::{Case, Domain};
use super::table::*;
use Domain::{Linear, Log, Values, Vector};
use glam::DVec4;

pub(super) const CASES: &[Case] = &[
    scalar(
        ["weighted_blending", "blend_weight"],
        &[Log(0.01, 1e5)],
        |x| vec![weighted_blending::blend_weight(x[0])],
        bound(0.0, 1e-5),
    ),
    case(
        ["weighted_blending", "weighted_color"],
        &[Vector(3, 0.0, 4.0), Linear(0.0, 1.0), Log(0.01, 1e5)],
        "weighted_color(v4(0u), x[4])",
        &["r.x", "r.y", "r.z", "r.w"],
        |x| weighted_blending::weighted_color(DVec4::new(x[0], x[1], x[2], x[3]), x[4]).to_array().to_vec(),
        bound(1e-7, 1e-5),
    ),
    // One minus an alpha near one keeps 2⁻²⁴ of 10⁻³.
    scalar(
        ["moment_transparency", "absorbance"],
        &[Linear(0.0, 0.999)],
        |x| vec![moment_transparency::absorbance(x[0])],
        bound(1e-4, 1e-5),
    ),
    scalar(
        ["moment_transparency", "transmittance_of"],
        &[Linear(-1.0, 9.9)],
        |x| vec![moment_transparency::transmittance_of(x[0])],
        bound(1e-7, 1e-5),
    ),
    case(
        ["moment_transparency", "warped_distance"],
        &[Log(1e-3, 1e6), Linear(0.05, 1.0), Linear(-1.0, 1.0)],
        "warped_distance(x[0], v2(1u))",
        SCALAR,
        |x| vec![moment_transparency::warped_distance(x[0], v2(x, 1))],
        bound(1e-5, 1e-5),
    ),
    case(
        ["moment_transparency", "power_moments"],
        &[Linear(-1.0, 1.0)],
        "power_moments(x[0])",
        &["r.x", "r.y", "r.z", "r.w"],
        |x| moment_transparency::power_moments(x[0]).to_array().to_vec(),
        ARITHMETIC,
    ),
    scalar(
        ["moment_transparency", "divisor"],
        &[Values(&[-1.0, -1e-9, 0.0, 1e-9, 0.25]), Values(&[1e-6])],
        |x| vec![moment_transparency::divisor(x[0], x[1])],
        ARITHMETIC,
    ),
    // Three layers at distances apart, seen from between and beyond them.
    case(
        ["moment_transparency", "moment_transmittance"],
        &[
            Linear(-0.95, -0.7),
            Linear(-0.2, 0.1),
            Linear(0.6, 0.9),
            Vector(3, 0.1, 1.0),
            Values(&[-1.0, -0.45, 0.35, 1.0]),
        ],
        "moment_transmittance(x[3] + x[4] + x[5], x[3] * vec4<f32>(x[0], x[0] * x[0], x[0] * x[0] * x[0], x[0] * x[0] \
         * x[0] * x[0]) + x[4] * vec4<f32>(x[1], x[1] * x[1], x[1] * x[1] * x[1], x[1] * x[1] * x[1] * x[1]) + x[5] * \
         vec4<f32>(x[2], x[2] * x[2], x[2] * x[2] * x[2], x[2] * x[2] * x[2] * x[2]), x[6], 0.001, 0.25)",
        SCALAR,
        |x| {
            let own = |i: usize| moment_transparency::power_moments(x[i]) * x[3 + i];
            let moments = own(0) + own(1) + own(2);
            vec![moment_transparency::moment_transmittance(x[3] + x[4] + x[5], moments, x[6], 1e-3, 0.25)]
        },
        bound(1e-5, 0.0),
    ),
];
