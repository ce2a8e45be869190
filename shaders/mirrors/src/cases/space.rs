//! Cases of the functions that deal in directions and positions.

use glam::DVec3;

use super::super::{environment, normal_map, sh, uv_transform};
use super::case::{Bound, Case, Domain};
use super::table::*;
use Domain::{Direction, Linear, Values, Vector};

/// Precision of atan2 and acos in WGSL: 4096 ulp, here of an angle divided by a full turn.
const ANGLE: Bound = Bound { absolute: 5e-4, relative: 0.0, period: 1.0 };
/// Precision of sin and cos in WGSL.
const SINE: Bound = bound(1.5e-3, 0.0);

pub(super) const CASES: &[Case] = &[
    case(
        ["sh", "evaluate_sh"],
        &[Vector(27, -1.0, 1.0), Direction, Linear(1.0, 1.5), Linear(1.0, 4.0)],
        "evaluate_sh(rows9(0u), v3(27u), x[30], x[31])",
        VEC3,
        |x| out3(sh::evaluate_sh(&rows9(x), v3(x, 27), x[30], x[31])),
        bound(1e-5, 0.0),
    ),
    case(
        ["sh", "irradiance_sh"],
        &[Vector(27, -1.0, 1.0), Direction],
        "irradiance_sh(rows9(0u), v3(27u))",
        VEC3,
        |x| out3(sh::irradiance_sh(&rows9(x), v3(x, 27))),
        bound(5e-6, 0.0),
    ),
    vec2(["sh", "sh_lobe_scale"], &[Linear(0.0, 1.0)], |x| out2(sh::sh_lobe_scale(x[0])), bound(3e-6, 2e-6)),
    case(
        ["sh", "specular_sh"],
        &[Vector(27, -1.0, 1.0), Direction, Linear(0.0, 1.0)],
        "specular_sh(rows9(0u), v3(27u), x[30])",
        VEC3,
        |x| out3(sh::specular_sh(&rows9(x), v3(x, 27), x[30])),
        bound(2e-5, 0.0),
    ),
    vec3(
        ["environment", "rotate_about_y"],
        &[Direction, Vector(2, -1.0, 1.0)],
        |x| out3(environment::rotate_about_y(v3(x, 0), v2(x, 3))),
        ARITHMETIC,
    ),
    vec2(
        ["environment", "equirect_uv_from_direction"],
        &[Direction],
        |x| out2(environment::equirect_uv_from_direction(v3(x, 0))),
        ANGLE,
    ),
    vec3(
        ["environment", "direction_from_equirect_uv"],
        &[Vector(2, 0.0, 1.0)],
        |x| out3(environment::direction_from_equirect_uv(v2(x, 0))),
        SINE,
    ),
    vec3(
        ["environment", "specular_dominant_direction"],
        &[Direction, Direction, Linear(0.0, 1.0)],
        |x| out3(environment::specular_dominant_direction(v3(x, 0), v3(x, 3), x[6])),
        ARITHMETIC,
    ),
    vec3(
        ["normal_map", "unpack_normal"],
        &[Vector(3, 0.0, 1.0), Linear(-2.0, 2.0)],
        |x| out3(normal_map::unpack_normal(v3(x, 0), x[3])),
        ARITHMETIC,
    ),
    vec3(["normal_map", "duff_tangent"], &[Direction], |x| out3(normal_map::duff_tangent(v3(x, 0))), bound(5e-6, 0.0)),
    case(
        ["normal_map", "vertex_normal"],
        &[Direction, Values(&[0.0, 1e-9, 0.1, 1.0])],
        "vertex_normal(v3(0u) * x[3], vec3<f32>(0.0, 1.0, 0.0))",
        VEC3,
        |x| out3(normal_map::vertex_normal(v3(x, 0) * x[3], DVec3::Y)),
        ARITHMETIC,
    ),
    // A nearly parallel tangent leaves a short sum to normalize.
    case(
        ["normal_map", "apply_normal_map"],
        &[Vector(2, -0.7, 0.7), Linear(0.3, 1.0), Direction, Direction, Values(&[1.0, -1.0])],
        "apply_normal_map(v3(0u), v3(3u), v3(6u), x[9])",
        VEC3,
        |x| out3(normal_map::apply_normal_map(v3(x, 0), v3(x, 3), v3(x, 6), x[9])),
        bound(2e-4, 0.0),
    ),
    case(
        ["uv_transform", "transform_uv"],
        &[Vector(8, -2.0, 2.0)],
        "transform_uv(v2(0u), v2(2u), v2(4u), v2(6u))",
        VEC2,
        |x| out2(uv_transform::transform_uv(v2(x, 0), v2(x, 2), v2(x, 4), v2(x, 6))),
        bound(3e-6, 0.0),
    ),
];

/// Nine coefficients from the first 27 numbers.
fn rows9(x: &[f64]) -> sh::Sh {
    std::array::from_fn(|i| v3(x, 3 * i))
}
