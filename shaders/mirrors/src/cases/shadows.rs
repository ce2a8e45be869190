//! Cases of the functions that deal in shadow maps.

use glam::{DVec2, DVec4};

use super::super::{contact_shadow, micro_shadow, shadow, shadow_moments};
use super::case::{Case, Domain};
use super::table::*;
use Domain::{Count, Direction, Linear, Values, Vector};

pub(super) const CASES: &[Case] = &[
    // Depths a thousandth apart, which single precision tells.
    case(
        ["contact_shadow", "contact_hides"],
        &[Count(1000), Values(&[0.5]), Values(&[0.0105])],
        "contact_hides(x[0] * 0.001, x[1], x[2])",
        SCALAR,
        |x| vec![f64::from(contact_shadow::contact_hides(x[0] * 0.001, x[1], x[2]))],
        EXACT,
    ),
    scalar(
        ["contact_shadow", "contact_fade"],
        &[Vector(2, -0.1, 1.1)],
        |x| vec![contact_shadow::contact_fade(v2(x, 0))],
        bound(1e-5, 0.0),
    ),
    // One minus a visibility near one keeps 2⁻²⁴ of at least 10⁻⁴.
    scalar(
        ["micro_shadow", "micro_shadowing"],
        &[Linear(-1.0, 1.0), Linear(0.0, 1.0)],
        |x| vec![micro_shadow::micro_shadowing(x[0], x[1])],
        bound(2e-3, 0.0),
    ),
    vec3(
        ["shadow", "normal_offset"],
        &[Direction, Direction, Direction, Vector(2, 0.001, 0.1)],
        |x| out3(shadow::normal_offset(v3(x, 0), v3(x, 3), v3(x, 6), v2(x, 9))),
        ARITHMETIC,
    ),
    case(
        ["shadow", "shadow_uvz_from_clip"],
        &[Vector(3, -2.0, 2.0), Linear(0.5, 4.0)],
        "shadow_uvz_from_clip(v4(0u))",
        VEC3,
        |x| out3(shadow::shadow_uvz_from_clip(DVec4::new(x[0], x[1], x[2], x[3]))),
        ARITHMETIC,
    ),
    // Within a texel a position of 2048 has 2⁻¹³ left.
    case(
        ["shadow", "tent_3x3"],
        &[Vector(2, 0.103, 0.903), Values(&[512.0, 1024.0, 2048.0])],
        "tent_3x3(v2(0u), vec2<f32>(x[2]))",
        &[
            "r.u.x",
            "r.u.y",
            "r.v.x",
            "r.v.y",
            "r.column_weight.x",
            "r.column_weight.y",
            "r.row_weight.x",
            "r.row_weight.y",
        ],
        |x| {
            let t = shadow::tent_3x3(v2(x, 0), DVec2::splat(x[2]));
            [t.u, t.v, t.column_weight, t.row_weight].map(|pair| pair.to_array()).concat()
        },
        bound(5e-4, 0.0),
    ),
    // A determinant that is nearly nothing is a difference of products: the directions are a sine of 0.1 apart or more, or
    // the same.
    case(
        ["shadow", "receiver_plane_slope"],
        &[
            Linear(0.5, 1.0),
            Linear(-0.2, 0.2),
            Linear(-1.0, 1.0),
            Linear(-0.2, 0.2),
            Linear(0.5, 1.0),
            Linear(-1.0, 1.0),
        ],
        "receiver_plane_slope(v3(0u), v3(3u))",
        VEC2,
        |x| out2(shadow::receiver_plane_slope(v3(x, 0), v3(x, 3))),
        bound(5e-6, 5e-6),
    ),
    // Precision of sin and cos in WGSL.
    case(
        ["shadow", "vogel_tap"],
        &[Count(16), Values(&[12.0, 16.0]), Linear(0.0, 6.3)],
        "vogel_tap(u32(x[0]), u32(x[1]), x[2])",
        VEC2,
        |x| out2(shadow::vogel_tap(x[0] as u32, x[1] as u32, x[2])),
        bound(1.5e-3, 0.0),
    ),
    scalar(["shadow", "hardened_kernel"], &[Linear(0.0, 1.0)], |x| vec![shadow::hardened_kernel(x[0])], ARITHMETIC),
    // One minus a depth near one keeps 2⁻²⁴ of an ulp, of at least 10⁻⁴.
    scalar(
        ["shadow", "penumbra_ratio_parallel"],
        &[Linear(0.0, 1.0), Linear(0.0, 1.0)],
        |x| vec![shadow::penumbra_ratio_parallel(x[0], x[1])],
        bound(1e-6, 2e-3),
    ),
    scalar(
        ["shadow", "penumbra_ratio_perspective"],
        &[Linear(0.01, 1.0), Linear(0.01, 1.0), Linear(0.0, 0.1)],
        |x| vec![shadow::penumbra_ratio_perspective(x[0], x[1], x[2])],
        bound(2e-5, 2e-6),
    ),
    case(
        ["shadow", "cascade_at"],
        &[Linear(0.0, 120.0)],
        "cascade_at(x[0], vec4<f32>(10.0, 20.0, 40.0, 100.0))",
        SCALAR,
        |x| vec![shadow::cascade_at(x[0], [10.0, 20.0, 40.0, 100.0]).into()],
        EXACT,
    ),
    scalar(
        ["shadow", "faded_visibility"],
        &[Linear(0.0, 1.0), Linear(0.0, 120.0), Values(&[0.0, 1e-4])],
        |x| vec![shadow::faded_visibility(x[0], x[1], x[2])],
        bound(5e-6, 0.0),
    ),
    scalar(
        ["shadow", "weakened_visibility"],
        &[Linear(0.0, 1.0), Linear(0.0, 1.0)],
        |x| vec![shadow::weakened_visibility(x[0], x[1])],
        ARITHMETIC,
    ),
    // Distances from a punctual light in m, including points inside its source.
    case(
        ["shadow", "cube_face_of"],
        &[Linear(-0.2, 0.2), Linear(-0.2, 0.2), Linear(-0.2, 0.2)],
        "cube_face_of(v3(0u))",
        SCALAR,
        |x| vec![shadow::cube_face_of(v3(x, 0)).into()],
        EXACT,
    ),
    // exp of 5.54: 3 + 2·5.54 ulp.
    case(
        ["shadow_moments", "warp_depth"],
        &[Linear(-0.1, 1.1)],
        "warp_depth(x[0], 5.54)",
        SCALAR,
        |x| vec![shadow_moments::warp_depth(x[0], 5.54)],
        bound(0.0, 1e-5),
    ),
    case(
        ["shadow_moments", "depth_moments"],
        &[Linear(0.0, 1.0), Vector(2, -0.1, 0.1)],
        "depth_moments(x[0], x[1], x[2], 5.54)",
        VEC2,
        |x| out2(shadow_moments::depth_moments(x[0], x[1], x[2], 5.54)),
        bound(0.0, 2e-5),
    ),
    case(
        ["shadow_moments", "least_variance"],
        &[Linear(0.01, 250.0), Linear(0.0, 0.01), Vector(2, -0.2, 0.2)],
        "least_variance(x[0], 5.54, x[1], v2(2u))",
        SCALAR,
        |x| vec![shadow_moments::least_variance(x[0], 5.54, x[1], v2(x, 2))],
        ARITHMETIC,
    ),
    // The square of up to ten is taken from the second moment, which is at least one more.
    case(
        ["shadow_moments", "moment_visibility"],
        &[Linear(0.0, 10.0), Linear(101.0, 200.0), Linear(0.0, 20.0), Linear(0.0, 1.0), Linear(0.0, 0.5)],
        "moment_visibility(v2(0u), x[2], x[3], x[4])",
        SCALAR,
        |x| vec![shadow_moments::moment_visibility(v2(x, 0), x[2], x[3], x[4])],
        bound(5e-5, 0.0),
    ),
];
