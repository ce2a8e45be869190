//! Cases of the functions that pass light through bodies.

use super::super::refraction;
use super::case::{Case, Domain};
use super::table::*;
use Domain::{Direction, Linear, Log, Vector};

pub(super) const CASES: &[Case] = &[
    // At an index of 1 a grazing ray goes on along the surface: the root of a cancelled difference.
    vec3(
        ["refraction", "refracted_path"],
        &[Direction, Direction, Linear(1.0, 2.5), Linear(0.0, 3.0)],
        |x| out3(refraction::refracted_path(v3(x, 0), v3(x, 3), x[6], x[7])),
        bound(3e-3, 0.0),
    ),
    vec3(
        ["refraction", "dispersed_ior"],
        &[Linear(1.0, 2.5), Linear(0.0, 10.0)],
        |x| out3(refraction::dispersed_ior(x[0], x[1])),
        ARITHMETIC,
    ),
    // exp is good to 3 + 2|x| ulp.
    vec3(
        ["refraction", "transmittance"],
        &[Vector(3, 0.0, 20.0), Linear(0.0, 2.0)],
        |x| out3(refraction::transmittance(v3(x, 0), x[3])),
        bound(1e-7, 1e-5),
    ),
    scalar(
        ["refraction", "transmission_spread"],
        &[Linear(0.0, 1.0), Linear(0.9, 2.5)],
        |x| vec![refraction::transmission_spread(x[0], x[1])],
        ARITHMETIC,
    ),
    // 3 / ior - 2 cancels: 1e-6 of rounding.
    scalar(
        ["refraction", "seen_transmission_spread"],
        &[Linear(0.0, 1.0), Linear(0.9, 2.5)],
        |x| vec![refraction::seen_transmission_spread(x[0], x[1])],
        bound(2e-6, 2e-6),
    ),
    // log2 is good to 2⁻²¹ near 1.
    scalar(
        ["refraction", "pyramid_lod"],
        &[Log(1e-4, 1e4)],
        |x| vec![refraction::pyramid_lod(x[0])],
        bound(2e-6, 2e-6),
    ),
];
