//! Surface lighting: D, V, F, energy compensation, punctual lights, normals, harmonics.

use super::{
    ALPHA, Build, COMPONENT, COSINE, Domain, LOW_ALPHA, MOST, NONE, NOV, ONE, Probe, SHARE, Values, both, bounded,
    in_half, is_any, is_positive, is_unit,
};
use Domain::{Direction, Vector};

/// Components that tilt a vector very slightly.
const TILT: Domain = Values(&[0.0, 6e-8, 6.1e-5, -1e-4, 0.001]);
/// Entries of an invalid and of an empty table (row 13).
const ALBEDO: Domain = Values(&[0.0, -0.0, -1.0, 6e-8, 0.3, 1.0, 161.0, f64::NAN]);
/// Squared distances, and inverse squared ranges (rows 16, 17).
const DISTANCE2: Domain = Values(&[0.0, 1e-12, 1e-6, 1e-4, 1.0, 1e12, 1e30, f64::INFINITY]);
const INV_RANGE2: Domain = Values(&[0.0, 1e-6, 1.0, 1e12, 1e30]);
/// Vectors without a usable direction, and short vectors with one (rows 8, 38).
const TINY: Domain = Values(&[0.0, -0.0, 1e-38, 1e-31, 1e-20, -1e-13, 1e-7, 1.0, -1.0, 1e30]);
const RADIANCE: Domain = Values(&[0.0, -65504.0, 65504.0, 1e30, f64::INFINITY, f64::NEG_INFINITY, f64::NAN]);
const COLOR: Domain = Vector(3, 0.0, 1.0);
const FAST: Domain = Values(&[0.0, 1.0]);
/// A light at and below the horizon of a surface that faces +z (row 2).
const BEHIND: Domain = Values(&[0.0, -0.0, -1e-8, -6e-8, -1e-4, -1.0]);
/// A sine and a cosine near the mirror direction.
const SIDE: Domain = Values(&[-1.0, -0.001, 0.0, 0.001, 0.9995]);

/// Returns true if D is at most its peak, to within a few roundings of f32 or f16.
fn below_peak(x: &[f32], y: &[f32], alpha: f32) -> bool {
    let alpha = f64::from(alpha.max(if x.is_empty() { 0.0 } else { 0.002 }));
    y[0] >= 0.0 && f64::from(y[0]) <= 1.01 / (std::f64::consts::PI * alpha * alpha)
}

pub(super) const PROBES: &[Probe] = &[
    both(1, "clamp_nov", &[COSINE], |_, y| y[0] >= 1e-4 - 3e-8),
    bounded(1, "v_smith_ggx_correlated", &[NOV, COSINE, LOW_ALPHA], in_half),
    bounded(1, "v_smith_ggx_correlated_fast", &[NOV, COSINE, LOW_ALPHA], in_half),
    // Exactly zero, of either sign.
    both(
        2,
        "reflect_light",
        &[
            NONE,
            NONE,
            ONE,
            SIDE,
            NONE,
            COMPONENT,
            SIDE,
            NONE,
            BEHIND,
            ALPHA,
            COLOR,
            COLOR,
            SHARE,
            Vector(3, 1.0, 2.0),
            FAST,
        ],
        |_, y| y.iter().all(|y| y.to_bits() == 0),
    ),
    Probe {
        row: 3,
        function: "d_ggx",
        build: Build::Full,
        parameters: &[Values(&[1.0, 1.000_000_1, 1.000_000_2, 1.002, 1.1, -1e-3, -1.1]), ALPHA],
        holds: |x, y| below_peak(x, y, x[1]),
        mirrored: true,
    },
    // Vectors slightly longer than 1.
    both(
        3,
        "reflect_light",
        &[
            NONE,
            NONE,
            Values(&[1.002]),
            NONE,
            NONE,
            ONE,
            NONE,
            NONE,
            Values(&[1.002]),
            ONE,
            COLOR,
            COLOR,
            SHARE,
            Vector(3, 1.0, 2.0),
            FAST,
        ],
        is_positive,
    ),
    bounded(
        3,
        "d_ggx_cross",
        &[NONE, NONE, ONE, TILT, TILT, Values(&[0.9995, 1.0, 1.000_000_2, 1.002]), LOW_ALPHA],
        |x, y| {
            // The minimum alpha of half floats; in f32, the largest half float is the bound.
            below_peak(x, y, x[6].max(if x[6] < 0.002 { 0.0079 } else { 0.0 })) || (y[0] <= MOST && x[6] < 0.002)
        },
    ),
    both(
        4,
        "alpha_from_roughness",
        &[Values(&[-1.0, 0.0, 6e-8, 0.02, 0.045, 0.089, 1.0, 2.0]), Values(&[0.089])],
        |x, y| (x[1] * x[1] - 1e-5..=1.0).contains(&y[0]),
    ),
    bounded(4, "d_ggx_cross", &[COMPONENT, COMPONENT, COMPONENT, COMPONENT, COMPONENT, COMPONENT, LOW_ALPHA], in_half),
    both(6, "f_schlick", &[SHARE, SHARE, SHARE, ONE, COSINE], |x, y| {
        // One rounding of a sum.
        y.iter().zip(x).all(|(f, f0)| (*f0 - 5e-4..=1.0).contains(f))
    }),
    both(6, "f_schlick_scalar", &[SHARE, ONE, COSINE], |x, y| (x[0] - 5e-4..=1.0).contains(&y[0])),
    both(6, "f90_from_f0", &[SHARE, SHARE, SHARE], |_, y| (0.0..=1.0).contains(&y[0])),
    // A light opposite the viewer has no half vector.
    bounded(
        7,
        "reflect_light",
        &[
            NONE,
            NONE,
            ONE,
            COMPONENT,
            NONE,
            COMPONENT,
            COMPONENT,
            NONE,
            COMPONENT,
            ALPHA,
            COLOR,
            COLOR,
            SHARE,
            Vector(3, 1.0, 3.26),
            FAST,
        ],
        is_positive,
    ),
    bounded(
        7,
        "reflect_light",
        &[
            COMPONENT,
            NONE,
            COMPONENT,
            Values(&[-0.001]),
            NONE,
            ONE,
            Values(&[0.001]),
            NONE,
            Values(&[-1.0, -0.999_999_5, -0.9995]),
            ALPHA,
            COLOR,
            COLOR,
            SHARE,
            Vector(3, 1.0, 3.26),
            FAST,
        ],
        is_positive,
    ),
    both(7, "half_vector", &[COMPONENT, NONE, COMPONENT, COMPONENT, NONE, COMPONENT], |_, y| {
        y.iter().map(|c| c * c).sum::<f32>() <= 1.002
    }),
    both(8, "vertex_normal", &[TINY, TINY, TINY, ONE], is_unit),
    bounded(8, "normalize_or", &[TINY, TINY, TINY, ONE], is_unit),
    bounded(8, "normalize_or", &[Direction, Values(&[0.0, 1e-38, 1e-30, 1e-20, 1e20])], is_unit),
    // The mean of opposite normals.
    both(9, "vertex_normal", &[NONE, NONE, Values(&[1e-9, -1e-9, 1e-7, -1e-7, 0.0, 1.0, -1.0]), ONE], is_unit),
    // Tangents that are missing or parallel to the normal; texels without a direction.
    both(
        10,
        "apply_normal_map",
        &[
            Values(&[0.0, 1.0]),
            NONE,
            Values(&[0.0, 1.0, -1.0]),
            NONE,
            NONE,
            Values(&[1.0, -1.0]),
            Values(&[0.0, 1e-9, 1.0]),
            NONE,
            Values(&[0.0, 1.0, -1.0]),
            Values(&[1.0, -1.0]),
        ],
        is_unit,
    ),
    // The result is perpendicular to the normal and has length 1.
    both(10, "duff_tangent", &[TILT, TILT, Values(&[-1.0, -0.999_999_94, 1.0])], |x, y| {
        let along: f32 = x.iter().zip(y).map(|(n, t)| n * t).sum();
        is_unit(x, y) && along.abs() < 2e-3
    }),
    both(10, "duff_tangent", &[Values(&[1.0, -1.0]), NONE, Values(&[0.0, -0.0])], is_unit),
    both(13, "energy_compensation", &[SHARE, SHARE, SHARE, ALBEDO], |x, y| {
        // 1/0.3 - 1, plus rounding.
        y.iter().zip(x).all(|(c, f0)| (1.0..=1.001 + 2.34 * f0).contains(c))
    }),
    // At least half a texel from the border.
    both(14, "dfg_uv", &[COSINE, COSINE, Values(&[16.0, 64.0, 128.0])], |x, y| {
        y.iter().all(|uv| (0.5 / x[2] - 1e-6..=1.0 - 0.5 / x[2] + 1e-6).contains(uv))
    }),
    both(14, "dfg_ggx", &[Values(&[1e-4, 0.01, 1.0, 1.000_000_1]), Values(&[0.045, 0.089, 1.0]), FAST], |_, y| {
        y.iter().all(|e| (0.0..=1.15).contains(e))
    }),
    both(14, "dfg_cloth", &[Values(&[1e-4, 0.01, 1.0, 1.000_000_1]), Values(&[0.0, 0.045, 1.0])], is_positive),
    bounded(16, "distance_attenuation", &[DISTANCE2, INV_RANGE2], |_, y| (0.0..=10_001.0).contains(&y[0])),
    bounded(16, "distance_attenuation_squared", &[DISTANCE2, INV_RANGE2], |_, y| (0.0..=10_001.0).contains(&y[0])),
    bounded(16, "light_far_fade", &[DISTANCE2, INV_RANGE2], |_, y| (0.0..=1.0).contains(&y[0])),
    both(
        18,
        "spot_attenuation",
        // Equal inner and outer angles: the CPU limits the scale to 1000, and the cosine is 1.
        &[COSINE, Values(&[1.0, 1000.0]), Values(&[-1000.0, -999.0, 0.0])],
        |_, y| (0.0..=1.0).contains(&y[0]),
    ),
    // Sunlight with the exposure of a dark scene, converted to half floats.
    bounded(19, "to_real3", &[Values(&[2.797, 91667.0, 1e30, -1e30]), Values(&[110_000.0]), NONE], |x, y| {
        y.iter().zip(x).all(|(y, x)| y.abs() <= MOST || (y == x && *x > MOST) || (y == x && *x < -MOST))
    }),
    Probe {
        row: 19,
        function: "to_real3",
        build: Build::Half,
        parameters: &[Values(&[65536.0, 1e30, -1e30]), Values(&[110_000.0]), ONE],
        holds: |_, y| y.iter().all(|y| y.abs() <= MOST),
        mirrored: false,
    },
    both(20, "sun_disc_radiance", &[Vector(3, 0.0, 128_000.0), Values(&[0.0, 1e-9, 0.004_65])], is_positive),
    both(20, "saturate_half", &[RADIANCE], in_half),
    both(20, "saturate_half3", &[RADIANCE, RADIANCE, RADIANCE], in_half),
    both(20, "all_finite3", &[RADIANCE, RADIANCE, RADIANCE], |x, y| {
        (y[0] > 0.5) == x.iter().all(|x| x.to_bits() & 0x7fff_ffff < 0x7f80_0000)
    }),
    both(27, "irradiance_sh", &[Vector(27, -1.0, 1.0), Direction], is_positive),
    both(27, "irradiance_sh2", &[Vector(12, -1.0, 1.0), Direction], is_positive),
    both(27, "irradiance_sh5", &[Vector(54, -1.0, 1.0), Direction], is_positive),
    both(27, "specular_sh", &[Vector(27, -1.0, 1.0), Direction, SHARE], is_positive),
    // Any coefficients must give non-negative light.
    bounded(28, "irradiance_sh", &[Vector(27, -65504.0, 65504.0), Direction], is_positive),
    both(56, "pow5", &[Values(&[1e-7, 6e-8, 6e-5, 0.01])], |x, y| y[0] >= 0.0 && y[0] <= x[0]),
    both(56, "specular_albedo", &[SHARE, SHARE, SHARE, SHARE, SHARE, SHARE], is_any),
];
