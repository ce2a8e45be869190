//! Cases of the functions that find lights by froxel.

use super::super::froxel;
use super::case::{Case, Domain};
use super::table::*;
use Domain::{Count, Linear, Log, Values};

pub(super) const CASES: &[Case] = &[
    // log2 within 2⁻²¹ or three ulp of up to 20, times up to ten, and a sum of up to 200.
    case(
        ["froxel", "froxel_slice"],
        &[Log(1e-3, 1e6), Linear(1.0, 10.0), Linear(-40.0, 10.0), Count(32)],
        "froxel_slice(x[0], x[1], x[2], u32(x[3]) + 1u)",
        SCALAR,
        |x| vec![froxel::froxel_slice(x[0], x[1], x[2], x[3] as u32 + 1)],
        bound(1e-4, 0.0),
    ),
    // Middles of pixels, about ends of tiles of 8 and of 120 pixels among them.
    case(
        ["froxel", "froxel_number"],
        &[
            Values(&[-0.5, 0.5, 7.5, 8.5, 119.5, 120.5, 1919.5, 4000.5, 16383.5]),
            Values(&[0.5, 7.5, 8.5, 359.5, 360.5, 1079.5]),
            Values(&[0.125, 1.0 / 120.0]),
            Values(&[0.0, 0.99, 1.01, 14.9, 15.0]),
        ],
        "froxel_number(v2(0u), x[2], x[3], vec3<u32>(16u, 9u, 16u))",
        SCALAR,
        |x| vec![f64::from(froxel::froxel_number(v2(x, 0), x[2], x[3], [16, 9, 16]))],
        EXACT,
    ),
];
