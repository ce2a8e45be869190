//! Cases of the functions that add frames up, and of those that make pictures larger and sharper.

use super::super::{sharpen, taa, upscale};
use super::case::{Case, Domain};
use super::table::*;
use Domain::{Linear, Log, Values, Vector};
use glam::DVec4;

/// Colors, and boxes of them.
const COLOR: Domain = Vector(3, 0.0, 4.0);
/// Values of a compressed color, including the maximum.
const COMPRESSED: Domain = Values(&[0.0, 0.1, 0.5, 0.9, 0.99, 1.0, 1.5]);

pub(super) const CASES: &[Case] = &[
    vec3(["taa", "ycocg_from_rgb"], &[COLOR], |x| out3(taa::ycocg_from_rgb(v3(x, 0))), ARITHMETIC),
    vec3(["taa", "rgb_from_ycocg"], &[COLOR], |x| out3(taa::rgb_from_ycocg(v3(x, 0))), bound(3e-6, 2e-6)),
    case(
        ["taa", "compress_range"],
        &[Log(1e-6, 65504.0), Log(1e-6, 65504.0), Values(&[0.0, 1.0, 65504.0])],
        "compress_range(v3(0u))",
        VEC3,
        |x| out3(taa::compress_range(v3(x, 0))),
        ARITHMETIC,
    ),
    // The difference from 1 has the rounding error of 1.
    case(
        ["taa", "expand_range"],
        &[COMPRESSED, COMPRESSED, COMPRESSED],
        "expand_range(v3(0u))",
        VEC3,
        |x| out3(taa::expand_range(v3(x, 0))),
        bound(1e-6, 3e-5),
    ),
    // The root of a difference of two numbers up to 8: near zero, of their rounding.
    vec3(
        ["taa", "deviation_of_five"],
        &[COLOR, Vector(3, 0.0, 40.0)],
        |x| out3(taa::deviation_of_five(v3(x, 0), v3(x, 3))),
        bound(1.5e-3, 2e-6),
    ),
    // Ways are differences of numbers up to 4, of a rounding of 2e-7; the least that decides is some hundredths.
    scalar(
        ["taa", "share_to_box"],
        &[COLOR, Vector(3, 1.0, 2.0), Vector(3, 0.5, 1.5), Vector(3, 1.6, 3.0)],
        |x| vec![taa::share_to_box(v3(x, 0), v3(x, 3), v3(x, 6), v3(x, 9))],
        bound(1e-4, 0.0),
    ),
    scalar(
        ["taa", "steadiness"],
        &[Linear(0.0, 4.0), Linear(0.0, 4.0)],
        |x| vec![taa::steadiness(x[0], x[1])],
        bound(1e-6, 2e-6),
    ),
    case(
        ["taa", "catmull_rom"],
        &[Linear(0.0, 1.0)],
        "catmull_rom(x[0])",
        &["r.x", "r.y", "r.z", "r.w"],
        |x| taa::catmull_rom(x[0]).to_vec(),
        ARITHMETIC,
    ),
    // Divided by at least a quarter.
    case(
        ["sharpen", "sharpened"],
        &[Vector(3, 0.0, 1.2), Vector(6, 0.0, 1.0), Vector(6, 0.0, 1.0), Linear(0.0, 1.0)],
        "sharpened(v3(0u), v3(3u), v3(6u), v3(9u), v3(12u), x[15])",
        VEC3,
        |x| out3(sharpen::sharpened(v3(x, 0), [3, 6, 9, 12].map(|at| v3(x, at)), x[15])),
        bound(1e-5, 1e-5),
    ),
    // A quotient of differences of numbers up to 1, the least of which are some hundredths.
    case(
        ["upscale", "edge_of"],
        &[Vector(5, 0.0, 1.0)],
        "edge_of(x[0], x[1], x[2], x[3], x[4])",
        VEC3,
        |x| out3(upscale::edge_of(x[0], x[1], x[2], x[3], x[4])),
        bound(1e-4, 1e-5),
    ),
    case(
        ["upscale", "kernel_of"],
        &[Vector(2, -1.0, 1.0), Linear(0.0, 2.0)],
        "kernel_of(v3(0u))",
        &["r.x", "r.y", "r.z", "r.w"],
        |x| upscale::kernel_of(v3(x, 0)).to_array().to_vec(),
        bound(1e-5, 1e-5),
    ),
    case(
        ["upscale", "kernel_weight"],
        &[Vector(2, -2.0, 2.0), Vector(2, -0.7, 0.7), Linear(1.0, 1.4), Linear(0.5, 1.0), Linear(0.0, 2.0)],
        "kernel_weight(v2(0u), v4(2u), x[6])",
        SCALAR,
        |x| vec![upscale::kernel_weight(v2(x, 0), DVec4::new(x[2], x[3], x[4], x[5]), x[6])],
        bound(1e-5, 1e-5),
    ),
];
