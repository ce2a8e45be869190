//! Cases of the functions that make a picture out of radiance.

use super::super::{dither, fullscreen, fxaa, luminance, quantize, rgbm, sky, srgb};
use super::case::{Bound, Case, Domain};
use super::table::*;
use Domain::{Count, Direction, Linear, Log, Values, Vector};

/// An encoded or linear channel and a little beyond.
const CHANNEL: Domain = Linear(-0.1, 1.1);
/// HDR colors.
const HDR: Domain = Vector(3, 0.0, 4.0);
/// pow as exp2 of a product: 3 + 2|x| ulp for an exponent of 10, of results up to one.
const POWER: Bound = bound(5e-6, 2e-5);

pub(super) const CASES: &[Case] = &[
    scalar(["srgb", "linear_from_srgb_channel"], &[CHANNEL], |x| vec![srgb::linear_from_srgb_channel(x[0])], POWER),
    scalar(["srgb", "srgb_from_linear_channel"], &[CHANNEL], |x| vec![srgb::srgb_from_linear_channel(x[0])], POWER),
    case(
        ["srgb", "linear_from_srgb"],
        &[CHANNEL, CHANNEL, CHANNEL],
        "linear_from_srgb(v3(0u))",
        VEC3,
        |x| out3(srgb::linear_from_srgb(v3(x, 0))),
        POWER,
    ),
    case(
        ["srgb", "srgb_from_linear"],
        &[CHANNEL, CHANNEL, CHANNEL],
        "srgb_from_linear(v3(0u))",
        VEC3,
        |x| out3(srgb::srgb_from_linear(v3(x, 0))),
        POWER,
    ),
    scalar(["luminance", "luminance"], &[HDR], |x| vec![luminance::luminance(v3(x, 0))], ARITHMETIC),
    // Positions up to 2000 leave 2⁻¹³ of the inner sum, times 53; and where it rounds across
    // a whole number the result moves by 1 - fract(52.98) = 0.017.
    scalar(
        ["dither", "interleaved_gradient_noise"],
        &[Vector(2, 0.5, 2000.5), Count(200)],
        |x| vec![dither::interleaved_gradient_noise(v2(x, 0), x[2] as u32)],
        Bound { absolute: 0.025, relative: 0.0, period: 1.0 },
    ),
    case(
        ["dither", "dither_offset"],
        &[Vector(2, 0.5, 2000.5), Count(200), Values(&[255.0, 1023.0])],
        "dither_offset(v2(0u), u32(x[2]), x[3]) * x[3]",
        SCALAR,
        |x| vec![dither::dither_offset(v2(x, 0), x[2] as u32, x[3]) * x[3]],
        Bound { absolute: 0.025, relative: 0.0, period: 1.0 },
    ),
    case(
        ["quantize", "quantize_mantissa"],
        &[Log(1e-9, 65000.0), Values(&[5.0, 6.0, 10.0]), Count(2)],
        "quantize_mantissa(x[0], u32(x[1]), x[2] > 0.5)",
        SCALAR,
        |x| vec![quantize::quantize_mantissa(x[0], x[1] as u32, x[2] > 0.5)],
        EXACT,
    ),
    case(
        ["quantize", "quantize_rgba16float"],
        &[Log(1e-9, 1e6), Linear(-2.0, 2.0), Values(&[-1e9, -0.0, 65504.0]), Linear(0.0, 1.0), Count(2)],
        "quantize_rgba16float(v4(0u), x[4] > 0.5)",
        &["r.x", "r.y", "r.z", "r.w"],
        |x| quantize::quantize_rgba16float(v3(x, 0).extend(x[3]), x[4] > 0.5).to_array().to_vec(),
        EXACT,
    ),
    case(
        ["quantize", "quantize_rg11b10ufloat"],
        &[Log(1e-9, 1e6), Linear(-2.0, 2.0), Log(1e-6, 1e5), Count(2)],
        "quantize_rg11b10ufloat(v3(0u), x[3] > 0.5)",
        &["r.x", "r.y", "r.z", "r.w"],
        |x| quantize::quantize_rg11b10ufloat(v3(x, 0), x[3] > 0.5).to_array().to_vec(),
        EXACT,
    ),
    case(
        ["rgbm", "linear_from_rgbm"],
        &[Vector(4, 0.0, 1.0)],
        "linear_from_rgbm(v4(0u))",
        &["r.x", "r.y", "r.z"],
        |x| rgbm::linear_from_rgbm(v3(x, 0).extend(x[3])).to_array().to_vec(),
        ARITHMETIC,
    ),
    scalar(
        ["fxaa", "fxaa_is_edge"],
        &[Linear(0.0, 1.0), Linear(0.0, 1.0), Linear(0.05, 0.2), Linear(0.03, 0.06)],
        |x| vec![f64::from(u8::from(fxaa::fxaa_is_edge(x[0], x[1], x[2], x[3])))],
        EXACT,
    ),
    case(
        ["fxaa", "fxaa_direction"],
        &[Vector(4, 0.0, 1.0)],
        "fxaa_direction(x[0], x[1], x[2], x[3])",
        VEC2,
        |x| out2(fxaa::fxaa_direction(x[0], x[1], x[2], x[3])),
        bound(2e-5, 0.0),
    ),
    scalar(
        ["fxaa", "fxaa_span_texels"],
        &[Vector(2, -1.0, 1.0), Linear(0.0, 1.0), Linear(2.0, 16.0)],
        |x| vec![fxaa::fxaa_span_texels(v2(x, 0), x[2], x[3])],
        bound(1e-6, 1e-5),
    ),
    case(
        ["fullscreen", "fullscreen_position"],
        &[Count(3), Linear(0.0, 1.0)],
        "fullscreen_position(u32(x[0]), x[1])",
        &["r.x", "r.y", "r.z", "r.w"],
        |x| fullscreen::fullscreen_position(x[0] as u32, x[1]).to_array().to_vec(),
        EXACT,
    ),
    vec2(
        ["fullscreen", "uv_from_clip"],
        &[Vector(2, -1.0, 3.0)],
        |x| out2(fullscreen::uv_from_clip(v2(x, 0))),
        ARITHMETIC,
    ),
    // acos is good to 2⁻¹¹ near its ends, and D multiplies it by up to 3.
    case(
        ["sky", "perez"],
        &[
            Vector(3, -1.5, -0.2),
            Vector(3, -0.8, -0.1),
            Vector(3, 0.0, 5.0),
            Vector(3, -3.0, -1.0),
            Vector(3, 0.0, 0.4),
            Linear(-0.2, 1.0),
            Linear(-1.0, 1.0),
        ],
        "perez(rows5(0u), x[15], x[16])",
        VEC3,
        |x| out3(sky::perez(&rows5(x), x[15], x[16])),
        bound(1e-2, 1e-3),
    ),
    case(
        ["sky", "linear_from_xyy"],
        &[Vector(2, 0.2, 0.45), Linear(0.0, 4.0)],
        "linear_from_xyy(v3(0u))",
        VEC3,
        |x| out3(sky::linear_from_xyy(v3(x, 0))),
        bound(2e-5, 1e-5),
    ),
    case(
        ["sky", "sky_radiance"],
        &[
            Vector(3, -1.5, -0.2),
            Vector(3, -0.8, -0.1),
            Vector(3, 0.0, 5.0),
            Vector(3, -3.0, -1.0),
            Vector(3, 0.0, 0.4),
            Vector(2, 0.28, 0.34),
            Linear(0.1, 1.0),
            Vector(3, 0.0, 1.0),
            Direction,
            Direction,
        ],
        "sky_radiance(rows5(0u), v3(15u), v3(18u), v3(21u), v3(24u))",
        VEC3,
        |x| out3(sky::sky_radiance(&rows5(x), v3(x, 15), v3(x, 18), v3(x, 21), v3(x, 24))),
        bound(0.2, 2e-2),
    ),
    // A sine of 0.004 has an absolute rounding of 1e-7; the step is a tenth of it wide.
    scalar(
        ["sky", "sun_disc"],
        &[Direction, Direction, Log(0.004, 0.5)],
        |x| vec![sky::sun_disc(v3(x, 0), v3(x, 3), x[6])],
        bound(1e-3, 0.0),
    ),
    // Near the end of the halo its rest is a difference of numbers up to one.
    scalar(
        ["sky", "sun_halo"],
        &[Direction, Direction, Log(1e-5, 0.1), Log(0.5, 300.0), Log(0.1, 100.0)],
        |x| vec![sky::sun_halo(v3(x, 0), v3(x, 3), x[6], x[7], x[8])],
        bound(1e-3, 0.0),
    ),
    vec3(
        ["sky", "sun_disc_radiance"],
        &[Vector(3, 0.0, 5.0), Log(0.001, 0.5)],
        |x| out3(sky::sun_disc_radiance(v3(x, 0), x[3])),
        bound(0.0, 5e-6),
    ),
];

/// Perez' A…E from the first 15 numbers.
fn rows5(x: &[f64]) -> [glam::DVec3; 5] {
    std::array::from_fn(|i| v3(x, 3 * i))
}
