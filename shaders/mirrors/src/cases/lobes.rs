//! Cases of the lobes beyond the standard one: anisotropy, clear coat, cloth, and what shapes them.

use glam::DVec3;

use super::super::{anisotropy, clear_coat, cloth, diffuse, fresnel, ggx, specular_aa, subsurface, thin_film};
use super::case::{Case, Domain};
use super::table::*;
use Domain::{Direction, Directions, Linear, Log, Values, Vector};

/// A cosine.
const COSINE: Domain = Linear(0.0, 1.0);
/// alpha of roughness 0.045 … 1.
const ALPHA: Domain = Log(0.002_025, 1.0);
/// alpha of roughness 0.089 … 1, what half floats hold.
const HALF_ALPHA: Domain = Log(0.007_921, 1.0);
/// Two of them.
const ALPHAS: Domain = Vector(2, 0.01, 1.0);
/// A color in [0, 1].
const COLOR: Domain = Vector(3, 0.0, 1.0);

pub(super) const CASES: &[Case] = &[
    // A cross product rounds by 1e-7, and half of alpha 0.002 is where that matters most.
    case(
        ["ggx", "d_ggx_cross"],
        &[Directions(1e-4, 2.0), ALPHA],
        "d_ggx_cross(real3(v3(0u)), real3(v3(3u)), real(dot(v3(0u), v3(3u))), real(x[6]))",
        SCALAR,
        |x| vec![ggx::d_ggx_cross(v3(x, 0), v3(x, 3), v3(x, 0).dot(v3(x, 3)), x[6])],
        bound(1e-6, 5e-4),
    )
    .half_over(&[Directions(1e-4, 2.0), HALF_ALPHA], bound(1e-3, 0.25)),
    scalar(
        ["fresnel", "f_schlick_scalar"],
        &[COSINE, COSINE, Linear(-0.1, 1.1)],
        |x| vec![fresnel::f_schlick_scalar(x[0], x[1], x[2])],
        ARITHMETIC,
    )
    .half(HALF_FRESNEL),
    scalar(["fresnel", "f90_from_f0"], &[Vector(3, 0.0, 0.03)], |x| vec![fresnel::f90_from_f0(v3(x, 0))], ARITHMETIC)
        .half(HALF_ARITHMETIC),
    vec2(
        ["anisotropy", "anisotropic_alpha"],
        &[ALPHA, Linear(-1.5, 1.5), Linear(0.002, 0.008)],
        |x| out2(anisotropy::anisotropic_alpha(x[0], x[1], x[2])),
        ARITHMETIC,
    )
    .half_over(&[HALF_ALPHA, Linear(-1.5, 1.5), Linear(0.008, 0.01)], bound(1e-5, 2e-3)),
    vec2(
        ["anisotropy", "gltf_anisotropic_alpha"],
        &[ALPHA, Linear(-0.5, 1.5), Linear(0.002, 0.008)],
        |x| out2(anisotropy::gltf_anisotropic_alpha(x[0], x[1], x[2])),
        ARITHMETIC,
    )
    .half_over(&[HALF_ALPHA, Linear(-0.5, 1.5), Linear(0.008, 0.01)], bound(1e-5, 2e-3)),
    case(
        ["anisotropy", "d_ggx_anisotropic"],
        &[ALPHAS, Direction],
        "d_ggx_anisotropic(real2(v2(0u)), real(x[2]), real(x[3]), real(abs(x[4])))",
        SCALAR,
        |x| vec![anisotropy::d_ggx_anisotropic(v2(x, 0), x[2], x[3], x[4].abs())],
        bound(1e-7, 1e-5),
    )
    .half(bound(1e-7, 1e-3)),
    // 1e-4 as f32 has it.
    case(
        ["anisotropy", "v_smith_ggx_correlated_anisotropic"],
        &[ALPHAS, Direction, Direction],
        "v_smith_ggx_correlated_anisotropic(real2(v2(0u)), real3(vec3<f32>(v2(2u), max(x[4], 1e-4))), \
            real3(vec3<f32>(v2(5u), max(x[7], 0.0))))",
        SCALAR,
        |x| {
            let (v, l) = (v3(x, 2), v3(x, 5));
            let v = DVec3::new(v.x, v.y, v.z.max(f64::from(1e-4_f32)));
            let l = DVec3::new(l.x, l.y, l.z.max(0.0));
            vec![anisotropy::v_smith_ggx_correlated_anisotropic(v2(x, 0), v, l)]
        },
        bound(1e-6, 1e-5),
    )
    .half_over(
        // xy and z of unit vectors: short in both is none of them.
        &[ALPHAS, Vector(2, -0.7, 0.7), Linear(1e-4, 1.0), Vector(2, -0.7, 0.7), COSINE],
        bound(1e-3, 1e-2),
    ),
    // The viewer nearly along the smooth direction: 1e-4 of length is left, with 1e-7 of rounding.
    vec3(
        ["anisotropy", "anisotropic_bent_normal"],
        &[Direction, Direction, Direction, Linear(-1.5, 1.5), COSINE],
        |x| out3(anisotropy::anisotropic_bent_normal(v3(x, 0), v3(x, 3), v3(x, 6), x[9], x[10])),
        bound(1e-3, 0.0),
    ),
    scalar(["clear_coat", "v_kelemen"], &[Linear(0.0, 1.0)], |x| vec![clear_coat::v_kelemen(x[0])], ARITHMETIC)
        .half(bound(0.0, 4e-3)),
    vec3(
        ["clear_coat", "f0_under_clear_coat"],
        &[COLOR],
        |x| out3(clear_coat::f0_under_clear_coat(v3(x, 0))),
        bound(1e-6, 5e-6),
    )
    .half(bound(2e-3, 2e-3)),
    vec3(
        ["clear_coat", "f0_under_clear_coat_fast"],
        &[COLOR],
        |x| out3(clear_coat::f0_under_clear_coat_fast(v3(x, 0))),
        ARITHMETIC,
    )
    .half(bound(1e-3, 2e-3)),
    scalar(
        ["clear_coat", "roughness_under_clear_coat"],
        &[COSINE, COSINE, COSINE],
        |x| vec![clear_coat::roughness_under_clear_coat(x[0], x[1], x[2])],
        ARITHMETIC,
    )
    .half(HALF_ARITHMETIC),
    // The exponent 1/2α reaches 1250 and multiplies what WGSL promises of log2.
    scalar(
        ["cloth", "d_charlie"],
        &[Linear(-0.1, 1.001), Values(&[0.0, 4e-4, 0.01, 0.1, 0.3, 1.0])],
        |x| vec![cloth::d_charlie(x[0], x[1])],
        bound(1e-6, 2e-3),
    )
    .half(bound(1e-3, 5e-3)),
    scalar(["cloth", "v_neubelt"], &[COSINE, COSINE], |x| vec![cloth::v_neubelt(x[0], x[1])], bound(1e-6, 5e-6))
        .half_over(&[Linear(1e-4, 1.0), COSINE], bound(0.0, 4e-3)),
    scalar(
        ["cloth", "sheen_attenuation"],
        &[COLOR, COSINE],
        |x| vec![cloth::sheen_attenuation(v3(x, 0), x[3])],
        ARITHMETIC,
    )
    .half(HALF_ARITHMETIC),
    scalar(["diffuse", "fd_transmitted"], &[Linear(-1.1, 1.1)], |x| vec![diffuse::fd_transmitted(x[0])], ARITHMETIC)
        .half(HALF_ARITHMETIC),
    // WGSL promises 3 + 2·|x| units of 2^x, over exponents down to -40, of which little is left.
    case(
        ["subsurface", "subsurface_scatter"],
        &[Linear(-1.0, 1.0), Linear(-1.0, 1.0), Linear(0.0, 40.0), COSINE],
        "subsurface_scatter(real(x[0]), real(x[1]), x[2], x[3])",
        SCALAR,
        |x| vec![subsurface::subsurface_scatter(x[0], x[1], x[2], x[3])],
        bound(1e-6, 1e-5),
    )
    .half(bound(2e-3, 2e-3)),
    scalar(["subsurface", "subsurface_ambient"], &[COSINE], |x| vec![subsurface::subsurface_ambient(x[0])], ARITHMETIC),
    // The root of what rounding leaves next to one.
    scalar(
        ["subsurface", "subsurface_roughness"],
        &[COSINE, COSINE],
        |x| vec![subsurface::subsurface_roughness(x[0], x[1])],
        bound(1e-3, 0.0),
    ),
    scalar(
        ["subsurface", "wrapped_cosine"],
        &[Linear(-1.0, 1.0)],
        |x| vec![subsurface::wrapped_cosine(x[0])],
        ARITHMETIC,
    )
    .half(HALF_ARITHMETIC),
    vec3(
        ["subsurface", "cloth_tint"],
        &[COLOR, Linear(-1.0, 1.0)],
        |x| out3(subsurface::cloth_tint(v3(x, 0), x[3])),
        ARITHMETIC,
    )
    .half(HALF_ARITHMETIC),
    // Eleven turns round by 1e-6, and WGSL promises 2^-11 of a cosine.
    vec3(
        ["thin_film", "film_sensitivity"],
        &[Linear(0.0, 5000.0), Vector(3, 0.0, 1.0)],
        |x| out3(thin_film::film_sensitivity(x[0], v3(x, 1))),
        bound(3e-3, 0.0),
    ),
    // Two waves of such cosines.
    vec3(
        ["thin_film", "thin_film_reflectance"],
        &[COSINE, Linear(1.0, 3.0), Linear(0.0, 1200.0), COLOR],
        |x| out3(thin_film::thin_film_reflectance(x[0], x[1], x[2], v3(x, 3))),
        bound(6e-3, 0.0),
    ),
    // At a cosine of 0.02 a tenth is left, by which rounding is divided.
    vec3(
        ["thin_film", "f0_from_reflectance"],
        &[COLOR, COSINE, Linear(0.02, 1.0)],
        |x| out3(thin_film::f0_from_reflectance(v3(x, 0), x[3], x[4])),
        bound(1e-5, 0.0),
    ),
    scalar(
        ["specular_aa", "normal_filtering"],
        &[Linear(0.045, 1.0), Vector(3, -0.3, 0.3), Vector(3, -0.3, 0.3), Linear(0.0, 0.5), Linear(0.0, 0.3)],
        |x| vec![specular_aa::normal_filtering(x[0], v3(x, 1), v3(x, 4), x[7], x[8])],
        ARITHMETIC,
    ),
];
