//! Cases of the functions of ambient light: harmonics, cube maps, occlusion, and how the tables
//! behind them are integrated.

use glam::{DVec2, DVec3};

use super::super::{cube, dfg_integration, image_light, occlusion, sampling, sh};
use super::case::{Case, Domain};
use super::table::*;
use Domain::{Count, Direction, Linear, Values, Vector};

/// A share.
const SHARE: Domain = Linear(0.0, 1.0);
/// alpha of roughness 0.09 … 1.
const ALPHA: Domain = Linear(0.008, 1.0);

/// The numbers as coefficients, three each.
fn rows<const N: usize>(x: &[f64]) -> [DVec3; N] {
    std::array::from_fn(|i| v3(x, 3 * i))
}

pub(super) const CASES: &[Case] = &[
    case(
        ["sh", "irradiance_sh2"],
        &[Vector(12, -1.0, 1.0), Direction],
        "irradiance_sh2(rows4(0u), v3(12u))",
        VEC3,
        |x| out3(sh::irradiance_sh2(&rows(x), v3(x, 12))),
        bound(2e-6, 0.0),
    ),
    // Polynomials up to 8, eighteen of them.
    case(
        ["sh", "irradiance_sh5"],
        &[Vector(54, -1.0, 1.0), Direction],
        "irradiance_sh5(rows18(0u), v3(54u))",
        VEC3,
        |x| out3(sh::irradiance_sh5(&rows(x), v3(x, 54))),
        bound(2e-5, 0.0),
    ),
    scalar(
        ["image_light", "specular_lod"],
        &[Linear(-0.1, 1.1), Linear(1.0, 8.0)],
        |x| vec![image_light::specular_lod(x[0], x[1])],
        ARITHMETIC,
    ),
    // A root near zero turns 1e-7 into 3e-4.
    scalar(
        ["image_light", "roughness_from_specular_lod"],
        &[Linear(0.0, 8.0), Linear(1.0, 8.0)],
        |x| vec![image_light::roughness_from_specular_lod(x[0], x[1])],
        bound(5e-4, 0.0),
    ),
    vec3(
        ["cube", "direction_from_cube_uv"],
        &[Count(6), Vector(2, 0.0, 1.0)],
        |x| out3(cube::direction_from_cube_uv(x[0] as u32, DVec2::new(x[1], x[2]))),
        ARITHMETIC,
    ),
    scalar(
        ["cube", "cube_solid_angle_weight"],
        &[Vector(2, 0.0, 1.0)],
        |x| vec![cube::cube_solid_angle_weight(v2(x, 0))],
        ARITHMETIC,
    ),
    vec3(
        ["occlusion", "gtao_multi_bounce"],
        &[Linear(-0.1, 1.1), Vector(3, -0.5, 4.0)],
        |x| out3(occlusion::gtao_multi_bounce(x[0], v3(x, 1))),
        bound(3e-6, 0.0),
    ),
    // pow by log2 and exp2, whose errors WGSL bounds absolutely.
    scalar(
        ["occlusion", "specular_occlusion"],
        &[Linear(1e-4, 1.0), SHARE, ALPHA],
        |x| vec![occlusion::specular_occlusion(x[0], x[1], x[2])],
        bound(2e-5, 0.0),
    ),
    // WGSL promises 4096 ulp of acos; caps that barely touch magnify it.
    scalar(
        ["occlusion", "spherical_caps_overlap"],
        &[SHARE, SHARE, Linear(-1.0, 1.0)],
        |x| vec![occlusion::spherical_caps_overlap(x[0], x[1], x[2])],
        bound(5e-3, 0.0),
    ),
    // The same over the solid angle of the lobe, 0.006 at alpha 0.05, where the fade leaves
    // half of it.
    scalar(
        ["occlusion", "specular_occlusion_cones"],
        &[Direction, Direction, SHARE, Linear(0.05, 1.0)],
        |x| vec![occlusion::specular_occlusion_cones(v3(x, 0), v3(x, 3), x[6], x[7])],
        bound(2e-2, 0.0),
    ),
    scalar(
        ["occlusion", "horizon_occlusion"],
        &[Direction, Direction],
        |x| vec![occlusion::horizon_occlusion(v3(x, 0), v3(x, 3))],
        ARITHMETIC,
    ),
    scalar(["sampling", "radical_inverse"], &[Count(1 << 24)], |x| vec![sampling::radical_inverse(x[0] as u32)], EXACT),
    case(
        ["sampling", "hammersley"],
        &[Count(4096), Values(&[4096.0])],
        "hammersley(u32(x[0]), u32(x[1]))",
        VEC2,
        |x| out2(sampling::hammersley(x[0] as u32, x[1] as u32)),
        ARITHMETIC,
    ),
    // Precision of sin and cos in WGSL.
    vec3(
        ["sampling", "sample_half_hemisphere"],
        &[Vector(2, 0.0, 1.0)],
        |x| out3(sampling::sample_half_hemisphere(v2(x, 0))),
        bound(1e-3, 0.0),
    ),
    scalar(
        ["sampling", "g1_smith_ggx"],
        &[Linear(1e-4, 1.0), ALPHA],
        |x| vec![sampling::g1_smith_ggx(x[0], x[1])],
        bound(1e-6, 5e-6),
    ),
    // sin and cos, and a root whose argument is a difference.
    case(
        ["sampling", "sample_visible_normal"],
        &[Direction, ALPHA, Vector(2, 0.0, 0.999)],
        "sample_visible_normal(vec3<f32>(v2(0u), max(abs(x[2]), 0.01)), x[3], v2(4u))",
        VEC3,
        |x| {
            let v = DVec3::new(x[0], x[1], x[2].abs().max(f64::from(0.01_f32)));
            out3(sampling::sample_visible_normal(v, x[3], v2(x, 4)))
        },
        bound(5e-3, 0.0),
    ),
    // One sample of 32 may fall on the other side of the horizon.
    case(
        ["dfg_integration", "dfg_ggx"],
        &[Linear(0.01, 1.0), Linear(0.045, 1.0), Count(2)],
        "dfg_ggx(x[0], x[1], x[2] > 0.5, 32u)",
        VEC2,
        |x| out2(dfg_integration::dfg_ggx(x[0], x[1], x[2] > 0.5, 32)),
        bound(5e-3, 0.0),
    )
    .half(bound(1e-2, 0.0)),
    case(
        ["dfg_integration", "dfg_cloth"],
        &[Linear(0.01, 1.0), Linear(0.1, 1.0)],
        "dfg_cloth(x[0], x[1], 64u)",
        SCALAR,
        |x| vec![dfg_integration::dfg_cloth(x[0], x[1], 64)],
        bound(1e-3, 1e-3),
    )
    .half(bound(2e-3, 2e-3)),
];
