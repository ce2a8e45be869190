//! Cases of what becomes of a color: grading, tone curves, vignettes, tables.

use super::super::{aces, agx, display_range, gamut, grading, gt7, night, primaries, table, tone_map, vignette};
use super::case::{Bound, Case, Domain};
use super::table::*;
use Domain::{Count, Linear, Log, Values, Vector};
use glam::DVec3;

/// HDR colors as a tone curve meets them.
const HDR: Domain = Vector(3, 0.0, 4.0);
/// HDR colors that break tone curves.
const EXTREME: Domain = Values(&[-1e9, -0.2, 0.0, 0.18, 1.0, 100.0, 161.6, 65504.0, 1e19]);
/// pow as exp2 of a product: 3 + 2|x| ulp for an exponent of 10, of results up to one.
const POWER: Bound = bound(5e-6, 2e-5);
/// A curve that maps a hundred to one keeps its argument's relative rounding.
const CURVE: Bound = bound(2e-6, 1e-5);
/// Weights of luminance.
const WEIGHTS: Domain = Vector(3, 0.1, 0.6);

/// Rec.2020's, for calls that state them.
const REC2020: DVec3 = primaries::LUMINANCE_REC2020;

pub(super) const CASES: &[Case] = &[
    vec3(["primaries", "rec2020_from_rec709"], &[HDR], |x| out3(primaries::rec2020_from_rec709(v3(x, 0))), ARITHMETIC),
    vec3(
        ["primaries", "rec709_from_rec2020"],
        &[HDR],
        |x| out3(primaries::rec709_from_rec2020(v3(x, 0))),
        bound(3e-6, 2e-6),
    ),
    // Cube roots by pow: 1e-6 of each, times up to 2.4.
    vec3(
        ["primaries", "oklab_from_rec709"],
        &[Vector(3, 0.01, 4.0)],
        |x| out3(primaries::oklab_from_rec709(v3(x, 0))),
        bound(2e-5, 2e-5),
    ),
    // Differences of cubes up to 8 times 4.
    case(
        ["primaries", "rec709_from_oklab"],
        &[Linear(0.0, 1.5), Vector(2, -0.3, 0.3)],
        "rec709_from_oklab(v3(0u))",
        VEC3,
        |x| out3(primaries::rec709_from_oklab(v3(x, 0))),
        bound(3e-5, 1e-5),
    ),
    // Twenty halvings leave a millionth of a line whose ends differ by 5 in light; its end on the gamut's surface is a
    // root, whose slope is 3.
    vec3(
        ["gamut", "map_into_gamut"],
        &[Vector(3, -0.5, 2.0)],
        |x| out3(gamut::map_into_gamut(v3(x, 0))),
        bound(2e-3, 1e-3),
    ),
    scalar(["aces", "aces_saturation"], &[HDR], |x| vec![aces::aces_saturation(v3(x, 0))], ARITHMETIC),
    // The root of a difference of squares.
    scalar(
        ["aces", "aces_glow"],
        &[Vector(3, 0.0, 0.3), Linear(0.0, 1.0)],
        |x| vec![aces::aces_glow(v3(x, 0), x[3])],
        bound(1e-4, 1e-4),
    ),
    // atan2 is good to 4096 ulp.
    scalar(["aces", "aces_redness"], &[HDR], |x| vec![aces::aces_redness(v3(x, 0))], bound(2e-3, 0.0)),
    vec3(
        ["aces", "tone_aces"],
        &[HDR, Values(&[1.0, 1.0 / 0.6])],
        |x| out3(aces::tone_aces(v3(x, 0), x[3])),
        bound(1e-4, 1e-4),
    ),
    // A sum of terms up to 130 that is at most one.
    vec3(["agx", "agx_sigmoid"], &[Vector(3, 0.0, 1.0)], |x| out3(agx::agx_sigmoid(v3(x, 0))), bound(5e-5, 1e-5)),
    vec3(
        ["agx", "agx_look"],
        &[Vector(3, 0.001, 1.0), Count(3)],
        |x| out3(agx::agx_look(v3(x, 0), x[3] as u32)),
        bound(1e-5, 1e-5),
    ),
    vec3(["agx", "tone_agx"], &[HDR, Count(3)], |x| out3(agx::tone_agx(v3(x, 0), x[3] as u32)), bound(2e-4, 1e-4)),
    // An exponent of 79.
    vec3(["gt7", "pq_from_nits"], &[Vector(3, 0.0, 10000.0)], |x| out3(gt7::pq_from_nits(v3(x, 0))), bound(1e-4, 1e-4)),
    // The same backward: an error of 1e-6 in the root is one of 1e-6 / 0.01 times 6.3 of what is left of a difference.
    vec3(["gt7", "nits_from_pq"], &[Vector(3, 0.3, 0.8)], |x| out3(gt7::nits_from_pq(v3(x, 0))), bound(1e-2, 3e-3)),
    vec3(
        ["gt7", "ictcp_from_rec2020"],
        &[Vector(3, 1.0, 1000.0)],
        |x| out3(gt7::ictcp_from_rec2020(v3(x, 0))),
        bound(5e-4, 0.0),
    ),
    case(
        ["gt7", "rec2020_from_ictcp"],
        &[Linear(0.4, 0.7), Vector(2, -0.05, 0.05)],
        "rec2020_from_ictcp(v3(0u))",
        VEC3,
        |x| out3(gt7::rec2020_from_ictcp(v3(x, 0))),
        bound(0.5, 1e-2),
    ),
    scalar(["gt7", "gt7_curve"], &[Linear(0.0, 20.0)], |x| vec![gt7::gt7_curve(x[0])], bound(1e-5, 1e-5)),
    vec3(["gt7", "tone_gt7"], &[Vector(3, 0.01, 4.0)], |x| out3(gt7::tone_gt7(v3(x, 0))), bound(3e-3, 3e-3)),
    vec3(
        ["display_range", "display_range_color"],
        &[Count(18)],
        |x| out3(display_range::display_range_color(x[0] as u32)),
        bound(1e-7, 0.0),
    ),
    case(
        ["display_range", "tone_display_range"],
        &[Log(1e-4, 1000.0), Log(1e-4, 1000.0), Log(1e-4, 1000.0)],
        "tone_display_range(v3(0u))",
        VEC3,
        |x| out3(display_range::tone_display_range(v3(x, 0))),
        bound(2e-5, 0.0),
    ),
    vec3(
        ["night", "night_adaptation"],
        &[Vector(3, 0.0, 2.0), Linear(0.0, 1.0)],
        |x| out3(night::night_adaptation(v3(x, 0), x[3])),
        bound(1e-5, 1e-5),
    ),
    vec3(
        ["grading", "log_c_from_linear"],
        &[Vector(3, -1.0, 20.0)],
        |x| out3(grading::log_c_from_linear(v3(x, 0))),
        ARITHMETIC,
    ),
    // An error of 3e-7 in LogC is one of 3e-7 · ln 10 / 0.244 in the logarithm of light, and light near black is a
    // difference of two numbers of 0.05.
    vec3(
        ["grading", "linear_from_log_c"],
        &[Vector(3, -0.2, 1.0)],
        |x| out3(grading::linear_from_log_c(v3(x, 0))),
        bound(1e-6, 2e-5),
    ),
    case(
        ["grading", "tonal_shares"],
        &[Linear(0.0, 2.0), Linear(0.0, 0.2), Linear(0.25, 0.5), Linear(0.3, 0.6), Linear(0.7, 1.0)],
        "tonal_shares(x[0], v4(1u))",
        VEC3,
        |x| out3(grading::tonal_shares(x[0], [x[1], x[2], x[3], x[4]])),
        bound(1e-5, 0.0),
    ),
    scalar(
        ["grading", "positive_power"],
        &[Linear(-1.0, 2.0), Linear(0.2, 3.0)],
        |x| vec![grading::positive_power(x[0], x[1])],
        POWER,
    ),
    vec3(
        ["grading", "slope_offset_power"],
        &[Vector(3, 0.0, 1.0), Vector(3, 0.0, 2.0), Vector(3, -0.5, 0.5), Vector(3, 1.0, 3.0)],
        |x| out3(grading::slope_offset_power(v3(x, 0), v3(x, 3), v3(x, 6), v3(x, 9))),
        POWER,
    ),
    vec3(
        ["grading", "contrast_about"],
        &[Vector(3, 0.0, 1.0), Linear(0.0, 1.0), Linear(0.0, 2.0)],
        |x| out3(grading::contrast_about(v3(x, 0), x[3], x[4])),
        ARITHMETIC,
    ),
    vec3(
        ["grading", "saturation"],
        &[HDR, WEIGHTS, Linear(0.0, 2.0)],
        |x| out3(grading::saturation(v3(x, 0), v3(x, 3), x[6])),
        bound(5e-6, 2e-6),
    ),
    vec3(
        ["grading", "vibrance"],
        &[HDR, WEIGHTS, Linear(0.0, 2.0)],
        |x| out3(grading::vibrance(v3(x, 0), v3(x, 3), x[6])),
        bound(1e-5, 1e-5),
    ),
    scalar(
        ["grading", "toe_and_shoulder"],
        &[Linear(0.0, 3.0), Linear(0.3, 3.0), Linear(0.2, 2.0), Linear(0.5, 2.0)],
        |x| vec![grading::toe_and_shoulder(x[0], x[1], x[2], x[3])],
        POWER,
    ),
    case(
        ["grading", "scale_luminance"],
        &[Vector(3, 0.01, 4.0), Linear(0.0, 1.0)],
        "scale_luminance(v3(0u), vec3<f32>(0.2627002, 0.6779981, 0.0593017), x[3])",
        VEC3,
        |x| out3(grading::scale_luminance(v3(x, 0), REC2020, x[3])),
        bound(5e-5, 1e-5),
    ),
    vec3(["tone_map", "tone_map_hill"], &[HDR], |x| out3(tone_map::tone_map_hill(v3(x, 0))), CURVE),
    vec3(["tone_map", "tone_map_filmic"], &[HDR], |x| out3(tone_map::tone_map_filmic(v3(x, 0))), CURVE),
    vec3(["tone_map", "tone_map_mobile"], &[HDR], |x| out3(tone_map::tone_map_mobile(v3(x, 0))), CURVE),
    vec3(["tone_map", "tone_map_neutral"], &[HDR], |x| out3(tone_map::tone_map_neutral(v3(x, 0))), CURVE),
    case(
        ["tone_map", "tone_generic"],
        &[HDR, Linear(0.5, 2.0), Linear(0.1, 1.0), Linear(0.9, 1.1)],
        "tone_generic(v3(0u), v3(3u))",
        VEC3,
        |x| out3(tone_map::tone_generic(v3(x, 0), v3(x, 3))),
        POWER,
    ),
    case(
        ["tone_map", "tone_in_rec2020"],
        &[Count(14)],
        "u32(tone_in_rec2020(u32(x[0])))",
        SCALAR,
        |x| vec![f64::from(u8::from(tone_map::tone_in_rec2020(x[0] as u32)))],
        EXACT,
    ),
    case(
        ["tone_map", "tone_curve"],
        &[Vector(3, 0.01, 4.0), Count(14)],
        "tone_curve(v3(0u), u32(x[3]), vec3<f32>(1.55, 0.26, 1.01))",
        VEC3,
        |x| out3(tone_map::tone_curve(v3(x, 0), x[3] as u32, DVec3::new(1.55, 0.26, 1.01))),
        bound(3e-3, 3e-3),
    ),
    // As far off as the farthest of what it calls; the conversion of primaries multiplies an error of a channel by up to
    // 2.3, and where only luminance goes through the curve, or what is outside is moved, less follows.
    case(
        ["tone_map", "tone_map"],
        &[EXTREME, EXTREME, EXTREME, Count(14), Count(2)],
        "tone_map(v3(0u), u32(x[3]), vec3<f32>(1.55, 0.26, 1.01), x[4] > 0.5, false)",
        VEC3,
        |x| out3(tone_map::tone_map(v3(x, 0), x[3] as u32, DVec3::new(1.55, 0.26, 1.01), x[4] > 0.5, false)),
        bound(8e-3, 1e-4),
    ),
    scalar(
        ["vignette", "vignette_transmittance"],
        &[Linear(0.0, 1.0), Linear(0.0, 7.0)],
        |x| vec![vignette::vignette_transmittance(x[0], x[1])],
        ARITHMETIC,
    ),
    case(
        ["vignette", "edge_share"],
        &[Vector(2, -0.5, 0.5), Linear(0.0, 3.0), Linear(1.0, 2.0), Linear(1.0, 30.0), Linear(0.0, 5.0)],
        "edge_share(v2(0u), v4(2u))",
        SCALAR,
        |x| vec![vignette::edge_share(v2(x, 0), [x[2], x[3], x[4], x[5]])],
        bound(2e-4, 1e-4),
    ),
    case(
        ["table", "table_coordinates"],
        &[Log(1e-6, 1e5), Linear(-1.0, 20.0), Linear(0.0, 0.1), Values(&[16.0, 32.0, 64.0, 1024.0])],
        "table_coordinates(v3(0u), x[3])",
        VEC3,
        |x| out3(table::table_coordinates(v3(x, 0), x[3])),
        ARITHMETIC,
    ),
];
