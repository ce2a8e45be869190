// Clear coat: a thin dielectric layer over the standard surface, of index 1.5, so f0 = 0.04.
//
// The coat's lobe is GGX with Kelemen's visibility. Light below is attenuated by 1 - F(coat). The
// base borders the coat instead of air, which lowers its f0.

import package::lib::real::{real, real3};

/// Visibility of Kelemen and Szirmay-Kalos ("A Microfacet Based Coupled Specular-Matte BRDF
/// Model with Importance Sampling", 2001), 1/(4·loh²). Sound only for glossy coats: against
/// height-correlated Smith it is within 1 % at roughness 0.089 and 60 % high at 0.6, nov 0.1.
/// At most 64102 (hard case 5); squared last, since loh² may be less than a half float holds.
fn v_kelemen(loh: real) -> real {
    let v = 0.5 / max(loh, 0.001974842);
    return v * v;
}

/// Returns f0 of a layer under a coat of index 1.5, from its f0 in air. With s = √f0 the index is
/// (1 + s)/(1 - s). In Fresnel's formula against 1.5, the poles cancel to ((5s - 1)/(5 - s))²,
/// which needs no guard at f0 = 1 (hard case 15).
fn f0_under_clear_coat(f0: real3) -> real3 {
    let s = sqrt(saturate(f0));
    let r = (5.0 * s - 1.0) / (5.0 - s);
    return r * r;
}

/// Returns f0 under the coat by Filament's cubic, without a square root, for the low preset. The
/// error is at most 0.022 for f0 above 0.04; below that it returns zero where the exact value rises
/// again.
fn f0_under_clear_coat_fast(f0: real3) -> real3 {
    return saturate(f0 * (f0 * (0.941892 - 0.263008 * f0) + 0.346479) - 0.0285998);
}

/// Returns the perceptual roughness of the base as seen through the coat. Light passes the coat
/// twice, so the base cannot look smoother than the coat. `strength` in [0, 1] blends.
fn roughness_under_clear_coat(base: real, coat: real, strength: real) -> real {
    return mix(base, max(base, coat), strength);
}
