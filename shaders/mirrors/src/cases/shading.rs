//! Cases of the functions that light surfaces.

use glam::DVec3;

use super::super::standard_surface::StandardSurface;
use super::super::{dfg, diffuse, fresnel, ggx, math, metal_rough, numerics, punctual, real, standard_surface};
use super::case::{Case, Domain};
use super::table::*;
use Domain::{Count, Direction, Linear, Log, Values, Vector};

/// A cosine.
const COSINE: Domain = Linear(0.0, 1.0);
/// Cosine toward the viewer, clamped as callers do.
const NOV: Domain = Linear(1e-4, 1.0);
/// alpha of roughness 0.045 … 1.
const ALPHA: Domain = Log(0.002_025, 1.0);
/// alpha of roughness 0.3 … 1: where a peak is not sharper than the rounding of its angle.
const ROUGH_ALPHA: Domain = Log(0.09, 1.0);
/// alpha of roughness 0.089 … 1, what half floats hold.
const HALF_ALPHA: Domain = Log(0.007_921, 1.0);
/// A cosine of at least 1e-4, like those toward the viewer: V is infinite where both vanish.
const HALF_NOL: Domain = Log(1e-4, 1.0);
/// A color in [0, 1].
const COLOR: Domain = Vector(3, 0.0, 1.0);
/// Values that arithmetic does not survive.
const HARD: Domain = Values(&[
    0.0,
    -0.0,
    1.0,
    -1.0,
    6.103_515_625e-5,
    161.5,
    65503.0,
    65504.0,
    65536.0,
    1e30,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
]);

pub(super) const CASES: &[Case] = &[
    case(["math", "sq"], &[Linear(-9.0, 9.0)], "sq(x[0])", SCALAR, |x| vec![math::sq(x[0])], ARITHMETIC),
    case(["math", "pow5"], &[Linear(-2.0, 2.0)], "pow5(real(x[0]))", SCALAR, |x| vec![math::pow5(x[0])], ARITHMETIC)
        .half(bound(1e-3, 4e-3)),
    scalar(["numerics", "saturate_half"], &[HARD], |x| vec![numerics::saturate_half(x[0])], EXACT),
    case(
        ["numerics", "saturate_half3"],
        &[HARD, HARD, HARD],
        "saturate_half3(v3(0u))",
        VEC3,
        |x| out3(numerics::saturate_half3(v3(x, 0))),
        EXACT,
    ),
    case(
        ["numerics", "all_finite3"],
        &[HARD, HARD, HARD],
        "all_finite3(v3(0u))",
        SCALAR,
        |x| vec![f64::from(numerics::all_finite3(v3(x, 0)))],
        EXACT,
    ),
    // The product as f32 makes it.
    case(
        ["numerics", "normalize_or"],
        &[Direction, Values(&[0.0, 1e-31, 1e-29, 1e-12, 1.0, 1e30])],
        "normalize_or(v3(0u) * x[3], vec3<f32>(0.0, 1.0, 0.0))",
        VEC3,
        |x| {
            let v = [0, 1, 2].map(|i| f64::from(x[i] as f32 * x[3] as f32));
            out3(numerics::normalize_or(DVec3::from_array(v), DVec3::Y))
        },
        ARITHMETIC,
    ),
    scalar(
        ["ggx", "alpha_from_roughness"],
        &[Linear(-0.5, 1.5), Linear(0.045, 0.089)],
        |x| vec![ggx::alpha_from_roughness(x[0], x[1])],
        ARITHMETIC,
    )
    .half_over(&[Linear(-0.5, 1.5), Linear(0.089, 0.1)], bound(0.0, 2e-3)),
    scalar(["ggx", "d_ggx"], &[Linear(-0.1, 1.001), ALPHA], |x| vec![ggx::d_ggx(x[0], x[1])], bound(1e-7, 5e-6)),
    scalar(
        ["ggx", "v_smith_ggx_correlated"],
        &[NOV, COSINE, ALPHA],
        |x| vec![ggx::v_smith_ggx_correlated(x[0], x[1], x[2])],
        bound(1e-6, 5e-6),
    )
    .half_over(&[NOV, HALF_NOL, HALF_ALPHA], bound(1e-3, 1e-2)),
    scalar(
        ["ggx", "v_smith_ggx_correlated_fast"],
        &[NOV, COSINE, ALPHA],
        |x| vec![ggx::v_smith_ggx_correlated_fast(x[0], x[1], x[2])],
        bound(1e-6, 5e-6),
    )
    .half_over(&[NOV, HALF_NOL, HALF_ALPHA], bound(1e-3, 1e-2)),
    vec3(
        ["fresnel", "f_schlick"],
        &[COLOR, Linear(0.0, 1.0), Linear(-0.1, 1.1)],
        |x| out3(fresnel::f_schlick(v3(x, 0), x[3], x[4])),
        ARITHMETIC,
    )
    .half(HALF_FRESNEL),
    case(
        ["real", "to_real3"],
        &[Vector(3, -65504.0, 65504.0)],
        "to_real3(v3(0u))",
        VEC3,
        |x| out3(real::to_real3(v3(x, 0))),
        EXACT,
    )
    .half(EXACT),
    case(
        ["diffuse", "fd_lambert"],
        &[COSINE],
        "fd_lambert() + 0.0 * real(x[0])",
        SCALAR,
        |_| vec![diffuse::fd_lambert()],
        ARITHMETIC,
    )
    .half(HALF_ARITHMETIC),
    vec3(
        ["metal_rough", "diffuse_from_base_color"],
        &[COLOR, COSINE],
        |x| out3(metal_rough::diffuse_from_base_color(v3(x, 0), x[3])),
        ARITHMETIC,
    )
    .half(HALF_ARITHMETIC),
    vec3(
        ["metal_rough", "f0_from_base_color"],
        &[COLOR, COSINE, Vector(3, 0.0, 0.2)],
        |x| out3(metal_rough::f0_from_base_color(v3(x, 0), x[3], v3(x, 4))),
        ARITHMETIC,
    )
    .half(HALF_ARITHMETIC),
    vec2(
        ["dfg", "dfg_uv"],
        &[Linear(-0.1, 1.1), Linear(-0.1, 1.1), Linear(16.0, 256.0)],
        |x| out2(dfg::dfg_uv(x[0], x[1], x[2])),
        ARITHMETIC,
    ),
    vec3(
        ["dfg", "specular_albedo"],
        &[COLOR, Linear(0.0, 1.0), Vector(2, 0.0, 1.0)],
        |x| out3(dfg::specular_albedo(v3(x, 0), x[3], v2(x, 4))),
        ARITHMETIC,
    )
    .half(HALF_ARITHMETIC),
    vec3(
        ["dfg", "energy_compensation"],
        &[COLOR, Linear(-0.5, 1.5)],
        |x| out3(dfg::energy_compensation(v3(x, 0), x[3])),
        ARITHMETIC,
    )
    .half(HALF_ARITHMETIC),
    scalar(
        ["punctual", "distance_attenuation"],
        &[Log(1e-8, 1e6), Log(1e-6, 10.0)],
        |x| vec![punctual::distance_attenuation(x[0], x[1])],
        bound(1e-6, 5e-6),
    ),
    scalar(
        ["punctual", "distance_attenuation_squared"],
        &[Log(1e-8, 1e6), Log(1e-6, 10.0)],
        |x| vec![punctual::distance_attenuation_squared(x[0], x[1])],
        bound(1e-6, 5e-6),
    ),
    // Five less up to five: 5e-7 of rounding.
    scalar(
        ["punctual", "light_far_fade"],
        &[Log(1.0, 1e8), Log(1e-8, 1.0)],
        |x| vec![punctual::light_far_fade(x[0], x[1])],
        bound(2e-6, 0.0),
    ),
    // The product is up to 100, of which 1e-5 is rounding.
    scalar(
        ["punctual", "spot_attenuation"],
        &[Linear(-1.0, 1.0), Linear(1.0, 100.0), Linear(-90.0, 0.0)],
        |x| vec![punctual::spot_attenuation(x[0], x[1], x[2])],
        bound(3e-5, 0.0),
    ),
    scalar(
        ["standard_surface", "clamp_nov"],
        &[Linear(-1.0, 1.0)],
        |x| vec![standard_surface::clamp_nov(x[0])],
        ARITHMETIC,
    )
    .half(HALF_ARITHMETIC),
    vec3(
        ["standard_surface", "half_vector"],
        &[Direction, Direction],
        |x| out3(standard_surface::half_vector(v3(x, 0), v3(x, 3))),
        ARITHMETIC,
    )
    .half(HALF_ARITHMETIC),
    // Half floats hold no vector of length one exactly.
    // nov rounds by 6e-8 of at least 1e-4, and V divides by it.
    case(
        ["standard_surface", "reflect_light"],
        &[Direction, Direction, Direction, ROUGH_ALPHA, COLOR, COLOR, Linear(0.0, 1.0), Vector(3, 1.0, 2.0), Count(2)],
        "reflect_light(StandardSurface(real3(v3(0u)), real(x[9]), real3(v3(3u)), real(max(dot(v3(0u), v3(3u)), 1e-4)), \
            real3(v3(10u)), real3(v3(13u)), real(x[16]), real3(v3(17u))), real3(v3(6u)), x[20] > 0.5)",
        VEC3,
        |x| {
            let (normal, view, light) = (v3(x, 0).normalize(), v3(x, 3).normalize(), v3(x, 6).normalize());
            let surface = StandardSurface {
                normal,
                alpha: x[9],
                view,
                nov: standard_surface::clamp_nov(normal.dot(view)),
                diffuse: v3(x, 10),
                f0: v3(x, 13),
                f90: x[16],
                compensation: v3(x, 17),
            };
            out3(standard_surface::reflect_light(&surface, light, x[20] > 0.5))
        },
        bound(1e-4, 2e-3),
    )
    .half(bound(1e-2, 5e-2)),
];
