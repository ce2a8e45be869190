//! Cases of the functions that follow rays over the picture.

use super::super::screen_ray;
use super::case::{Case, Domain};
use super::table::*;
use Domain::{Linear, Log, Values, Vector};

/// z in view space, from close to the eye to far away.
const AHEAD: Domain = Linear(-20.0, -0.01);
/// Depth as it is stored.
const DEPTH: Domain = Linear(0.0, 1.0);
/// What half a texel, the middle and the border of a picture have; and what lies outside.
const START: Domain = Vector(2, -1.0, 65.0);
/// Ways along an axis, both, and neither.
const WAY: Domain = Values(&[0.0, -0.0, 1e-5, -1e-3, 0.5, -7.0, 63.0, -1e3, 1e4]);

pub(super) const CASES: &[Case] = &[
    // The difference of two z of up to 20 m is off by 2e-6 m.
    scalar(
        ["screen_ray", "ray_length_m"],
        &[AHEAD, Linear(-1.0, 1.0), Linear(-0.5, -0.05), Log(0.01, 100.0)],
        |x| vec![screen_ray::ray_length_m(x[0], x[1], x[2], x[3])],
        bound(4e-6, 2e-5),
    ),
    case(
        ["screen_ray", "share_in_picture"],
        &[START, WAY, WAY],
        "share_in_picture(v2(0u), v2(2u), vec2<f32>(64.0))",
        SCALAR,
        |x| vec![screen_ray::share_in_picture(v2(x, 0), v2(x, 2), glam::DVec2::splat(64.0))],
        ARITHMETIC,
    ),
    scalar(
        ["screen_ray", "ray_meets"],
        &[AHEAD, AHEAD, AHEAD, Linear(0.0, 1.0)],
        |x| vec![f64::from(screen_ray::ray_meets(x[0], x[1], x[2], x[3]))],
        EXACT,
    ),
    scalar(
        ["screen_ray", "share_at_depth"],
        &[DEPTH, DEPTH, Values(&[0.0, -0.3, 0.3, 1e-3, -1e-5]), Linear(0.0, 0.4), Linear(0.5, 1.0)],
        |x| vec![screen_ray::share_at_depth(x[0], x[1], x[2], x[3], x[4])],
        ARITHMETIC,
    ),
    scalar(
        ["screen_ray", "rises_from_plane"],
        &[Values(&[-1.0, -0.0, 0.0, 1e-6, 0.01, 3.0]), Values(&[-1.0, 0.0, 1e-6, 0.015, 1.0])],
        |x| vec![f64::from(screen_ray::rises_from_plane(x[0], x[1]))],
        EXACT,
    ),
    scalar(["screen_ray", "reach_fade"], &[Linear(-0.1, 1.2)], |x| vec![screen_ray::reach_fade(x[0])], ARITHMETIC),
    // The quotient may be far above one before it is cut off.
    scalar(
        ["screen_ray", "roughness_fade"],
        &[Linear(0.0, 1.0), Linear(0.0, 1.0)],
        |x| vec![screen_ray::roughness_fade(x[0], x[1])],
        bound(2e-6, 2e-6),
    ),
];
