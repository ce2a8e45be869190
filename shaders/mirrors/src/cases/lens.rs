//! Cases of the functions between the scene and the sensor: fog, bloom, lens flare, depth of field.

use super::super::{bloom, dof, flare, fog};
use super::case::{Case, Domain};
use super::table::*;
use Domain::{Count, Linear, Log, Values, Vector};

/// Exponents of density over a way, with those where the form changes.
const DECAY: Domain =
    Values(&[-1000.0, -50.0, -2.0, -0.0101, -0.0099, -1e-6, 0.0, 1e-6, 0.0099, 0.0101, 2.0, 50.0, 1e9]);

/// Radii of circles of confusion, in pixels.
const RADIUS: Domain = Linear(-32.0, 32.0);

pub(super) const CASES: &[Case] = &[
    // exp(40) is good to 83 units in the last place, and what 1 - e^-x loses at 0.01 is no less.
    scalar(["fog", "mean_decay"], &[Linear(-45.0, 45.0)], |x| vec![fog::mean_decay(x[0])], bound(0.0, 2e-5)),
    // Two exponentials of up to 40, whose arguments are off by 2e-6 of themselves.
    case(
        ["fog", "fog_optical_depth"],
        &[Log(1e-6, 10.0), DECAY, Values(&[0.0, 0.5, 7.0]), Log(1e-3, 1e5), Values(&[0.0, 1.0])],
        "fog_optical_depth(x[0], x[1], x[2], x[3], x[4])",
        SCALAR,
        |x| vec![fog::fog_optical_depth(x[0], x[1], x[2], x[3], x[4])],
        bound(1e-9, 3e-4),
    ),
    scalar(
        ["fog", "fog_opacity"],
        &[Log(1e-6, 1e20), Values(&[0.0, 0.5, 1.0])],
        |x| vec![fog::fog_opacity(x[0], x[1])],
        ARITHMETIC,
    ),
    // The logarithm is off by 2⁻²¹, times the exponent.
    scalar(
        ["fog", "fog_glow"],
        &[Linear(-1.0, 1.001), Log(0.1, 200.0)],
        |x| vec![fog::fog_glow(x[0], x[1])],
        bound(1e-4, 1e-3),
    ),
    case(
        ["bloom", "tent_weights"],
        &[Linear(0.0, 1.0)],
        "tent_weights(x[0])",
        &["r.x", "r.y", "r.z", "r.w"],
        |x| bloom::tent_weights(x[0]).to_vec(),
        ARITHMETIC,
    ),
    scalar(["bloom", "brightest"], &[Vector(3, 0.0, 65504.0)], |x| vec![bloom::brightest(v3(x, 0))], EXACT),
    case(
        ["bloom", "firefly_weight"],
        &[Log(1e-4, 65504.0), Log(1e-4, 65504.0), Values(&[0.0, 1.0, 65504.0])],
        "firefly_weight(v3(0u))",
        SCALAR,
        |x| vec![bloom::firefly_weight(v3(x, 0))],
        ARITHMETIC,
    ),
    case(
        ["bloom", "glowing"],
        &[
            Log(1e-4, 4094.0),
            Log(1e-4, 4094.0),
            Values(&[0.0, 1.0, 4094.0]),
            Values(&[0.0, 1.0, 7.0]),
            Values(&[0.0, 1.0]),
            Values(&[0.0, 1e-3, 1.0]),
        ],
        "glowing(v3(0u), x[3], x[4], x[5])",
        VEC3,
        |x| out3(bloom::glowing(v3(x, 0), x[3], x[4], x[5])),
        ARITHMETIC,
    ),
    scalar(
        ["flare", "flare_ring"],
        &[Linear(0.0, 1.5), Linear(0.0, 0.5), Values(&[0.0, 0.1, 1.0])],
        |x| vec![flare::flare_ring(x[0], x[1], x[2])],
        bound(1e-5, 0.0),
    ),
    case(
        ["flare", "ghost_place"],
        &[Vector(2, 0.003, 0.997), Linear(0.0, 0.6), Count(2)],
        "ghost_place(v2(0u), x[2], x[3])",
        VEC2,
        |x| out2(flare::ghost_place(v2(x, 0), x[2], x[3])),
        ARITHMETIC,
    ),
    case(
        ["flare", "flare_direction"],
        &[Linear(0.51, 1.0), Linear(0.0, 1.0), Linear(0.5, 2.5)],
        "flare_direction(v2(0u), x[2])",
        VEC2,
        |x| out2(flare::flare_direction(v2(x, 0), x[2])),
        bound(5e-5, 0.0),
    ),
    // Middles of cells, where a neighbor counts nothing and the sine is of a small number.
    // The sine is good to 2⁻¹¹, times 437 and halved.
    scalar(
        ["flare", "starburst_noise"],
        &[Values(&[0.5 / 256.0, 1.5 / 256.0, 2.5 / 256.0, 5.5 / 256.0])],
        |x| vec![flare::starburst_noise(x[0])],
        bound(0.11, 0.0),
    ),
    // Star rays have no effect near the center.
    case(
        ["flare", "starburst"],
        &[Linear(0.499, 0.5), Linear(0.499, 0.5), Linear(-2.0, 2.0)],
        "starburst(v2(0u), x[2])",
        SCALAR,
        |x| vec![flare::starburst(v2(x, 0), x[2])],
        bound(1e-4, 0.0),
    ),
    case(
        ["dof", "inverse_distance"],
        &[Linear(0.0, 1.0), Values(&[0.0, 0.01]), Values(&[0.1, 1.0]), Linear(-1.5, -0.5), Linear(0.0, 0.05)],
        "inverse_distance(x[0], vec4<f32>(x[1], x[2], x[3], x[4]))",
        SCALAR,
        |x| vec![dof::inverse_distance(x[0], glam::DVec4::new(x[1], x[2], x[3], x[4]))],
        ARITHMETIC,
    ),
    // In focus, and far from where it jumps.
    case(
        ["dof", "coc_radius"],
        &[
            Log(0.01, 0.2),
            Values(&[1.0, 2.0]),
            Values(&[0.0, 1.5, 30.0, 1e6]),
            Values(&[16.0, 32.0]),
            Values(&[8.0, 32.0]),
        ],
        "coc_radius(x[0], x[1], x[2], v2(3u))",
        SCALAR,
        |x| vec![dof::coc_radius(x[0], x[1], x[2], v2(x, 3))],
        bound(1e-5, 2e-6),
    ),
    case(["dof", "coc_opacity"], &[RADIUS], "coc_opacity(x[0])", SCALAR, |x| vec![dof::coc_opacity(x[0])], ARITHMETIC),
    scalar(
        ["dof", "coc_reaches"],
        &[RADIUS, Linear(0.0, 40.0), Values(&[1.0, 2.0, 8.0])],
        |x| vec![dof::coc_reaches(x[0], x[1], x[2])],
        bound(1e-5, 0.0),
    ),
    scalar(
        ["dof", "coc_density"],
        &[RADIUS, Values(&[1.0, 2.0, 8.0])],
        |x| vec![dof::coc_density(x[0], x[1])],
        ARITHMETIC,
    ),
    // Away from where it jumps: at √2 times a power of two times the rings less a half.
    scalar(
        ["dof", "ring_level"],
        &[Values(&[3.0, 5.0]), Values(&[0.0, 0.5, 2.6, 5.0, 11.0, 22.0, 32.0])],
        |x| vec![dof::ring_level(x[0], x[1])],
        EXACT,
    ),
];
