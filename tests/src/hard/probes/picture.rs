//! Picture processing: stored formats, edges, noise, froxels, vignettes.

use super::{Domain, Probe, RADIANCE, Values, both, bounded, is_any, is_positive, is_share};

/// Luma of a flat area, of an edge, and of a picture before the tone curve (row 50).
const LUMA: Domain = Values(&[0.0, 1e-8, 0.25, 1.0, 50.0, 65504.0]);
/// Large pixel coordinates (row 55).
const PIXEL: Domain = Values(&[0.5, 2000.5, 1e4, 1e5, 1e6]);

pub(super) const PROBES: &[Probe] = &[
    // A sun in the view direction: rounding makes the cosine exceed 1.
    both(
        35,
        "perez",
        &[
            Domain::Vector(3, -1.5, -0.2),
            Domain::Vector(3, -0.8, -0.1),
            Domain::Vector(3, 0.0, 5.0),
            Domain::Vector(3, -3.0, -1.0),
            Domain::Vector(3, 0.0, 0.4),
            Values(&[-1.0, 0.0, 1.0]),
            Values(&[1.000_000_1, 1.001, -1.000_000_1, -1.001]),
        ],
        is_any,
    ),
    both(26, "quantize_rg11b10ufloat", &[RADIANCE, RADIANCE, RADIANCE, Values(&[0.0, 1.0])], |_, y| {
        y[..3].iter().zip([65024.0, 65024.0, 64512.0]).all(|(y, most)| (0.0..=most).contains(y))
    }),
    both(
        26,
        "quantize_rgba16float",
        &[Values(&[-1e9, 0.0, 65504.0, 7e4, 1e30]), RADIANCE, Values(&[1e30]), Values(&[1.0]), Values(&[0.0, 1.0])],
        |_, y| y.iter().all(|y| y.abs() <= 65504.0),
    ),
    both(50, "fxaa_direction", &[LUMA, LUMA, LUMA, LUMA], |x, y| {
        let length2 = y[0] * y[0] + y[1] * y[1];
        let flat = x.iter().all(|l| *l == x[0]);
        if flat { length2 == 0.0 } else { length2 <= 1.001 }
    }),
    both(50, "fxaa_is_edge", &[LUMA, LUMA, Values(&[0.05, 0.125]), Values(&[0.03, 0.06])], |x, y| {
        x[0] != x[1] || y[0] == 0.0
    }),
    both(
        50,
        "fxaa_span_texels",
        &[Values(&[0.0, -0.0, 1e-30, 1.0]), Values(&[0.0, 1e-30, 1.0]), Values(&[0.0, 8.0]), Values(&[0.0, 4.0])],
        |_, y| (0.0..=6.0).contains(&y[0]),
    ),
    bounded(55, "interleaved_gradient_noise", &[PIXEL, PIXEL, Values(&[0.0, 63.0, 64.0, 1e6])], is_share),
    bounded(55, "dither_offset", &[PIXEL, PIXEL, Values(&[0.0, 1e6]), Values(&[255.0])], |_, y| {
        y[0].abs() <= 0.5 / 255.0 * 255.0
    }),
    both(
        57,
        "froxel_slice",
        &[
            Values(&[-1.0, -0.0, 0.0, 1e-38, 1.0, 1e30, f64::INFINITY]),
            Values(&[1.0, 10.0]),
            Values(&[-40.0, 0.0]),
            Values(&[0.0, 31.0]),
        ],
        |x, y| (0.0..=x[3]).contains(&y[0]),
    ),
    both(
        57,
        "froxel_number",
        &[Values(&[-1e9, -0.5, 0.5, 1e9]), Values(&[-1.0, 0.5, 1e9]), Values(&[0.125]), Values(&[0.0, 15.0])],
        |_, y| (0.0..2304.0).contains(&y[0]),
    ),
    both(52, "vignette_transmittance", &[Values(&[0.0, 0.5, 1e30]), Values(&[0.0, 7.0])], is_share),
    both(
        52,
        "edge_share",
        &[
            Values(&[0.0, -0.5, 0.5, 1.0]),
            Values(&[0.0, 0.5, 1.0]),
            Values(&[0.0, 3.0, 1000.0]),
            Values(&[1.0, 777.0]),
            Values(&[1.0, 30.0]),
            Values(&[0.0, 5.0]),
        ],
        is_share,
    ),
    // Toward the sun and away from it; a disc of no size, a halo of no size.
    both(
        20,
        "sun_halo",
        &[
            Values(&[0.0]),
            Values(&[0.0, 1e-4]),
            Values(&[1.0]),
            Values(&[0.0]),
            Values(&[0.0]),
            Values(&[1.0, -1.0]),
            Values(&[0.0, 1e-5]),
            Values(&[0.0, 1e3, 1e12]),
            Values(&[0.01, 80.0, 1e4]),
        ],
        // Nothing away from the sun, where the halo ends at all.
        |x, y| is_share(x, y) && (x[5] > 0.0 || x[7] == 0.0 || y[0] == 0.0),
    ),
    both(
        20,
        "sun_disc",
        &[
            Values(&[0.0]),
            Values(&[0.0, 1e-4]),
            Values(&[1.0]),
            Values(&[0.0]),
            Values(&[0.0]),
            Values(&[1.0, -1.0]),
            Values(&[1e-6, 0.004_65]),
        ],
        is_share,
    ),
    both(
        40,
        "equirect_uv_from_direction",
        &[Values(&[0.0, -0.0, 1e-38]), Values(&[1.0, -1.0, 1.000_000_1, -1.000_000_1]), Values(&[0.0, -0.0])],
        |_, y| y.iter().all(|y| (0.0..=1.0).contains(y)),
    ),
    both(20, "linear_from_xyy", &[Values(&[0.3]), Values(&[0.0, -0.1, 1e-6, 0.3]), Values(&[0.0, 1.0])], is_positive),
    both(35, "roughness_from_specular_lod", &[Values(&[-1.0, 0.0, 4.0, 5.0, 100.0]), Values(&[0.0, 4.0])], is_share),
    both(35, "specular_lod", &[Values(&[-1.0, 0.0, 1.0, 2.0]), Values(&[4.0])], |_, y| (0.0..=4.0).contains(&y[0])),
    both(35, "sample_half_hemisphere", &[Values(&[0.0, 1.0, 1.000_000_1]), Values(&[0.0, 1.0])], is_any),
    both(14, "g1_smith_ggx", &[Values(&[0.0, 1e-4, 1.0, 1.000_000_1]), Values(&[0.0, 0.002, 1.0])], |_, y| {
        (0.0..=1.001).contains(&y[0])
    }),
];
