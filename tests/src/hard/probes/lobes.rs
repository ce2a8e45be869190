//! Material lobes other than the standard one.

use super::{
    COMPONENT, COSINE, Domain, LOW_ALPHA, NONE, ONE, Probe, SHARE, Values, both, bounded, in_half, is_any, is_positive,
    is_share,
};
use Domain::Vector;

/// Strengths of anisotropy, and values outside the range (row 11).
const ANISOTROPY: Domain = Values(&[-1.5, -1.0, 0.0, 1.0, 1.5]);
const FLOOR: Domain = Values(&[0.007_921]);
const HELD: Domain = Values(&[0.007_921, 0.1, 1.0]);
/// Reflectances of the base under a thin film, and values outside 0…1.
const BASE_F0: Domain = Values(&[-0.1, 0.0, 0.04, 1.0, 1.5]);
/// Film thicknesses and path lengths in nm: zero, one wavelength, beyond coherence, near the largest f32.
const THICKNESS_NM: Domain = Values(&[0.0, 1e-3, 380.0, 1e5, 3e38]);

pub(super) const PROBES: &[Probe] = &[
    bounded(5, "v_kelemen", &[COSINE], in_half),
    bounded(5, "v_kelemen", &[Values(&[0.0, 1e-3, 1.97e-3])], in_half),
    both(11, "anisotropic_alpha", &[LOW_ALPHA, ANISOTROPY, FLOOR], |_, y| y.iter().all(|a| (0.0079..=1.0).contains(a))),
    both(11, "gltf_anisotropic_alpha", &[LOW_ALPHA, ANISOTROPY, FLOOR], |_, y| {
        y.iter().all(|a| (0.0079..=1.0).contains(a))
    }),
    bounded(11, "d_ggx_anisotropic", &[HELD, HELD, COSINE, COSINE, COSINE], is_positive),
    bounded(
        11,
        "v_smith_ggx_correlated_anisotropic",
        &[LOW_ALPHA, LOW_ALPHA, COMPONENT, COMPONENT, COSINE, COMPONENT, COMPONENT, COSINE],
        in_half,
    ),
    // The viewer looks along the smooth direction.
    both(
        11,
        "anisotropic_bent_normal",
        &[
            NONE,
            NONE,
            ONE,
            ONE,
            NONE,
            NONE,
            Values(&[1.0, -1.0, 0.999_999_9]),
            Values(&[0.0, 1e-6]),
            NONE,
            ANISOTROPY,
            SHARE,
        ],
        |_, y| y.iter().map(|c| c * c).sum::<f32>() <= 1.001,
    ),
    both(12, "d_charlie", &[COSINE, LOW_ALPHA], |_, y| {
        // (2 + 1/alpha) / 2π at the smallest alpha, 4e-4.
        (0.0..=400.0).contains(&y[0])
    }),
    bounded(12, "v_neubelt", &[COSINE, COSINE], |x, y| {
        // Negative cosines make the denominator negative; its lower limit keeps the result finite.
        in_half(x, y)
    }),
    both(12, "sheen_attenuation", &[Vector(3, 0.0, 2.0), Values(&[0.0, 1.0, 4.0])], is_share),
    both(15, "f0_under_clear_coat", &[Values(&[-0.1, 0.0, 1.0, 1.5]), SHARE, SHARE], |_, y| {
        y.iter().all(|f| *f <= 1.0)
    }),
    both(15, "f0_under_clear_coat_fast", &[Values(&[-0.1, 0.0, 1.0, 2.0]), SHARE, SHARE], is_share),
    // An index of refraction below that of air.
    both(15, "refracted_path", &[NONE, NONE, COSINE, NONE, NONE, ONE, Values(&[0.0, 0.5, 1.0, 1.5]), ONE], is_any),
    both(15, "transmission_spread", &[SHARE, Values(&[0.0, 0.5, 1.0, 2.5])], is_positive),
    both(15, "seen_transmission_spread", &[SHARE, Values(&[0.0, 0.5, 1.0, 2.5])], |_, y| (0.0..=0.317).contains(&y[0])),
    both(15, "pyramid_lod", &[Values(&[-1.0, 0.0, 1e-30, 1e-3, 1.0, 1e30])], is_positive),
    // Films of zero and extreme thickness, on any base, at every angle.
    both(
        15,
        "thin_film_reflectance",
        &[COSINE, Values(&[0.5, 1.0, 1.8]), THICKNESS_NM, BASE_F0, NONE, Values(&[0.5, 1.0])],
        is_share,
    ),
    both(15, "film_sensitivity", &[Values(&[0.0, 1e5, 3e38, f64::INFINITY]), NONE, Values(&[0.5]), ONE], is_any),
    both(15, "f0_from_reflectance", &[SHARE, Values(&[-0.1, 1.0, 1.5]), NONE, SHARE, COSINE], is_share),
    both(15, "dispersed_ior", &[Values(&[0.5, 1.0, 1.5, 1e30]), Values(&[0.0, 1.0, 1e3, 1e38])], |_, y| {
        y.iter().all(|ior| (1.0..=1e4).contains(ior))
    }),
    // Exponents of none and of all, and a light right behind.
    both(
        2,
        "subsurface_scatter",
        &[Values(&[-1.002, -1.0, -0.5, 0.0, 1.002]), COSINE, Values(&[0.0, 12.234, 1e4]), SHARE],
        |_, y| (0.0..0.3185).contains(&y[0]),
    ),
    both(2, "subsurface_ambient", &[SHARE], is_share),
    both(2, "subsurface_roughness", &[SHARE, SHARE], is_share),
    both(2, "wrapped_cosine", &[Values(&[-1.002, -0.5, 0.0, 1.0, 1.002])], is_share),
    both(2, "cloth_tint", &[Vector(3, -0.1, 1.1), Values(&[-1.002, 0.0, 1.002])], is_share),
    // Light from the front is not transmitted.
    both(2, "fd_transmitted", &[Values(&[0.0, -0.0, 0.1, 1.0, 1.002, -1.002])], |x, y| {
        y.iter().all(|through| (0.0..0.3185).contains(through) && (x[0] < 0.0 || *through == 0.0))
    }),
    both(
        56,
        "normal_filtering",
        &[
            Values(&[0.0, 0.045, 0.089, 1.0]),
            Vector(3, -100.0, 100.0),
            Vector(3, -100.0, 100.0),
            Values(&[0.0, 0.25, 1.0]),
            Values(&[0.0, 0.18, 2.0]),
        ],
        is_share,
    ),
];
