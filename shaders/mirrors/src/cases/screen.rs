//! Cases of the functions that look into the depth of a picture: positions, normals, ambient occlusion.

use glam::{DVec2, DVec4};

use super::super::unproject::Projection;
use super::super::{bilateral, cone_trace, depth_normal, depth_pyramid, gtao, sao, unproject};
use super::case::{Bound, Case, Domain};
use super::table::*;
use Domain::{Count, Direction, Linear, Log, Values, Vector};

/// Depth 0.1…10 km at a near plane of 0.1 m, reversed.
const DEPTH: Domain = Log(1e-5, 1.0);
/// Normalized device coordinates.
const NDC: Domain = Vector(2, -1.0, 1.0);
/// Scale on x and y, slide, offset.
const WINDOW: [Domain; 3] = [Vector(2, 0.5, 3.0), Vector(2, -0.2, 0.2), Vector(2, -0.2, 0.2)];
/// A central projection with an infinite far plane, whose `depth` is (0, near, -1, 0), at `x[3]` and after: near is `x[3]`.
const CENTRAL: &[Domain] = &[NDC, DEPTH, Linear(0.05, 1.0), WINDOW[0], WINDOW[1], WINDOW[2]];
/// The projection of a central view in WGSL.
const CENTRAL_CALL: &str =
    "view_position(v2(0u), x[2], Projection(vec4<f32>(0.0, x[3], -1.0, 0.0), v2(4u), v2(6u), v2(8u)))";

fn central(x: &[f64], near: usize) -> Projection {
    let two = |at: usize| DVec2::new(x[at], x[at + 1]);
    Projection {
        depth: DVec4::new(0.0, x[near], -1.0, 0.0),
        scale: two(near + 1),
        slide: two(near + 3),
        offset: two(near + 5),
    }
}

/// An angle that a normal may have toward the viewer, in radians.
const ANGLE: Domain = Linear(-1.5, 1.5);
/// WGSL promises 2⁻¹¹ of sines and cosines of up to π.
const TRIGONOMETRY: Bound = bound(1e-3, 0.0);

/// Lengths of taps, in m: within a radius of 0.3 m, at its end, beyond, beyond half floats.
const TAP_M: Domain = Values(&[0.0, 1e-4, 0.003, 0.03, 0.1, 0.2, 0.29, 0.31, 1.0, 1e6]);

pub(super) const CASES: &[Case] = &[
    case(
        ["unproject", "view_z"],
        &[DEPTH, Linear(0.05, 1.0)],
        "view_z(x[0], vec4<f32>(0.0, x[1], -1.0, 0.0))",
        SCALAR,
        |x| vec![unproject::view_z(x[0], DVec4::new(0.0, x[1], -1.0, 0.0))],
        bound(0.0, 2e-6),
    ),
    // Sums of numbers up to 10⁵ m times what is divided by: relative to z, of which the mirror has more.
    case(
        ["unproject", "view_position"],
        CENTRAL,
        CENTRAL_CALL,
        VEC3,
        |x| out3(unproject::view_position(DVec2::new(x[0], x[1]), x[2], central(x, 3))),
        bound(0.05, 4e-6),
    ),
    case(
        ["unproject", "ndc_from_view"],
        &[Vector(2, -10.0, 10.0), Linear(-100.0, -1.0), Linear(0.05, 1.0), WINDOW[0], WINDOW[1], WINDOW[2]],
        "ndc_from_view(v3(0u), Projection(vec4<f32>(0.0, x[3], -1.0, 0.0), v2(4u), v2(6u), v2(8u)))",
        VEC3,
        |x| out3(unproject::ndc_from_view(v3(x, 0), central(x, 3))),
        bound(2e-5, 2e-6),
    ),
    case(
        ["depth_pyramid", "finer_texel"],
        &[Count(4096), Count(4096)],
        "finer_texel(vec2<i32>(v2(0u)))",
        VEC2,
        |x| depth_pyramid::finer_texel([x[0] as i32, x[1] as i32]).map(f64::from).to_vec(),
        EXACT,
    ),
    case(
        ["depth_pyramid", "finest_texel"],
        &[Count(256), Count(256), Count(8)],
        "finest_texel(vec2<i32>(v2(0u)), i32(x[2]))",
        VEC2,
        |x| depth_pyramid::finest_texel([x[0] as i32, x[1] as i32], x[2] as i32).map(f64::from).to_vec(),
        EXACT,
    ),
    // Away from powers of two, where a logarithm may fall to either side.
    case(
        ["depth_pyramid", "pyramid_level"],
        &[Values(&[-1.0, 0.0, 1.5, 7.0, 15.9, 16.1, 31.0, 33.0, 100.0, 500.0, 1e6]), Count(8)],
        "pyramid_level(x[0], i32(x[1]))",
        SCALAR,
        |x| vec![f64::from(depth_pyramid::pyramid_level(x[0], x[1] as i32))],
        EXACT,
    ),
    case(
        ["depth_normal", "continues_ahead"],
        &[Vector(5, 0.0, 1.0)],
        "continues_ahead(v2(0u), x[2], v2(3u))",
        &["select(0.0, 1.0, r)"],
        |x| vec![f64::from(depth_normal::continues_ahead([x[0], x[1]], x[2], [x[3], x[4]]))],
        EXACT,
    ),
    case(
        ["depth_normal", "continues_ahead_inside"],
        &[Count(4), Count(4), Count(2), Vector(5, 0.0, 1.0)],
        "continues_ahead_inside(vec2<i32>(v2(0u)), vec2<i32>(i32(x[2]), 1 - i32(x[2])), vec2<i32>(3, 2), v2(3u), x[5], v2(6u))",
        &["select(0.0, 1.0, r)"],
        |x| {
            let [column, row, along] = [x[0], x[1], x[2]].map(|c| c as i32);
            let (axis, sides) = ([along, 1 - along], ([x[3], x[4]], [x[6], x[7]]));
            let ahead = depth_normal::continues_ahead_inside([column, row], axis, [3, 2], sides.0, x[5], sides.1);
            vec![f64::from(ahead)]
        },
        EXACT,
    ),
    case(
        ["sao", "sao_tap_distance"],
        &[Count(64), Linear(0.0, 1.0), Log(0.01, 0.4)],
        "sao_tap_distance(x[0], x[1], x[2])",
        SCALAR,
        |x| vec![sao::sao_tap_distance(x[0], x[1], x[2])],
        ARITHMETIC,
    ),
    case(
        ["sao", "sao_term"],
        &[Direction, TAP_M, Direction, Linear(0.0, 0.01), Values(&[0.0])],
        "sao_term(v3(0u) * x[3], v3(4u), 0.3, x[7], x[8])",
        SCALAR,
        |x| vec![sao::sao_term(v3(x, 0) * x[3], v3(x, 4), 0.3, x[7], x[8])],
        bound(1e-5, 5e-6),
    )
    // u·n is off by three roundings of up to 2⁻¹¹, which the least denominator, 0.01, makes 0.05 of 5.
    .half(bound(0.06, 2e-2)),
    scalar(
        ["sao", "sao_obscurance"],
        &[Linear(-0.01, 2.0), Linear(0.0, 2.0)],
        |x| vec![sao::sao_obscurance(x[0], x[1])],
        bound(1e-6, 5e-6),
    ),
    // Error of the polynomial.
    scalar(["gtao", "acos_held"], &[Linear(-1.001, 1.001)], |x| vec![gtao::acos_held(x[0])], bound(8e-5, 0.0)),
    scalar(["gtao", "slice_arc"], &[ANGLE, ANGLE], |x| vec![gtao::slice_arc(x[0], x[1])], TRIGONOMETRY),
    scalar(["gtao", "slice_whole"], &[ANGLE], |x| vec![gtao::slice_whole(x[0])], TRIGONOMETRY),
    scalar(["gtao", "slice_share"], &[Linear(-4.0, 4.0), ANGLE], |x| vec![gtao::slice_share(x[0], x[1])], TRIGONOMETRY),
    // Some twenty sines over twelve.
    vec2(
        ["gtao", "slice_bent"],
        &[Linear(-3.0, 0.0), Linear(0.0, 3.0), ANGLE],
        |x| out2(gtao::slice_bent(x[0], x[1], x[2])),
        bound(2e-3, 0.0),
    ),
    // Away from the edges of sectors.
    // Halves, since a float holds no more than 24 bits.
    case(
        ["gtao", "sector_bits"],
        &[
            Values(&[-0.1, 0.0, 0.01, 0.3, 0.51, 0.97]),
            Values(&[0.0, 0.01, 0.3, 0.52, 0.98, 1.0, 1.1]),
            Values(&[0.0, 0.3, 0.7]),
        ],
        "vec2<u32>(sector_bits(x[0], x[1], x[2]) & 0xffffu, sector_bits(x[0], x[1], x[2]) >> 16u)",
        VEC2,
        |x| {
            let bits = gtao::sector_bits(x[0], x[1], x[2]);
            vec![f64::from(bits & 0xffff), f64::from(bits >> 16)]
        },
        EXACT,
    ),
    case(
        ["gtao", "slice_turn"],
        &[Count(4096), Count(4096)],
        "slice_turn(vec2<i32>(v2(0u)))",
        SCALAR,
        |x| vec![gtao::slice_turn([x[0] as i32, x[1] as i32])],
        EXACT,
    ),
    case(
        ["gtao", "slice_offset"],
        &[Count(4096), Count(4096)],
        "slice_offset(vec2<i32>(v2(0u)))",
        SCALAR,
        |x| vec![gtao::slice_offset([x[0] as i32, x[1] as i32])],
        EXACT,
    ),
    // Depths of 5 m are off by 5e-7 m, of slices a centimeter thick.
    scalar(
        ["cone_trace", "cone_slice"],
        &[
            Linear(4.0, 6.0),
            Linear(4.0, 6.0),
            Linear(0.01, 0.2),
            Linear(-0.9, 0.9),
            Linear(0.0, 0.02),
            Linear(0.1, 2.0),
        ],
        |x| vec![cone_trace::cone_slice(x[0], x[1], x[2], x[3], x[4], x[5])],
        bound(2e-4, 0.0),
    ),
    scalar(
        ["bilateral", "bilateral_weight"],
        &[Linear(-0.1, 0.1), Linear(0.01, 0.1)],
        |x| vec![bilateral::bilateral_weight(x[0], x[1])],
        bound(1e-6, 0.0),
    ),
];
