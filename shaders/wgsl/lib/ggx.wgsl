// The microfacet terms of the metal-rough specular lobe: D and V of f = D · V · F.
//
// Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007 (GGX);
// Heitz, "Understanding the Masking-Shadowing Function", JCGT 2014 (height-correlated Smith);
// Hammon, "PBR Diffuse Lighting for GGX+Smith Microsurfaces", GDC 2017 (fast form).
//
// alpha = roughness², where roughness is glTF's perceptual roughness. Dot products arrive
// clamped by the caller: nov ≥ 1e-4 and nol > 0.

import package::lib::math::PI;
import package::lib::real::{real, real3};

/// Scale of sines and cosines before squaring, removed afterwards. Squares of values below 0.0078
/// are subnormal in half floats, and some devices flush them to zero. At alpha 0.0079 this would
/// make D fifteen times too large.
@if(HALF)
const SQUARE_SCALE: real = 64.0;
@else
const SQUARE_SCALE: real = 1.0;

/// Minimum denominator in `d_ggx_cross`: alpha² at the smallest roughness.
@if(HALF)
const D_FLOOR: real = 6.27e-5;
@else
const D_FLOOR: real = 1e-12;

/// alpha from perceptual roughness, held above `floor` (0.045 is safe in f32, 0.089 in f16:
/// below, alpha⁴ vanishes or the peak 1/(π·alpha²) overflows; hard case 4).
fn alpha_from_roughness(roughness: real, floor: real) -> real {
    let r = clamp(roughness, floor, 1.0);
    return r * r;
}

/// Evaluates the GGX normal distribution in 1/sr, within [0, 1/(π·alpha²)].
///
/// 1 - noh² is computed as (1 - noh)(1 + noh). The subtraction is exact near one, so the error is a
/// few ulp of noh; the textbook form loses 7 % at roughness 0.045. noh is clamped to one, because a
/// dot product of rounded unit vectors may exceed it (hard case 3). Always f32: a half-float noh
/// has lost the angle.
fn d_ggx(noh: f32, alpha: f32) -> f32 {
    let c = clamp(noh, 0.0, 1.0);
    let a = c * alpha;
    let k = alpha / ((1.0 - c) * (1.0 + c) + a * a);
    return k * k * (1.0 / PI);
}

/// Evaluates the GGX distribution from unit vectors, with 1 - noh² = |n × h|² by Lagrange's
/// identity. In f16, where a rounded noh has lost the angle, this form has an error of 1 % at
/// roughness 0.089; in f32 it gains little. The result is at most 65464, which fits a half float
/// and is reached only below roughness 0.047. The last product is f32, because a GPU may compute k
/// · k first, which overflows half floats. At and below the horizon, the result is that at the
/// horizon. The same applies to opposite vectors, whose h is zero.
fn d_ggx_cross(n: real3, h: real3, noh: real, alpha: real) -> real {
    let scale2 = SQUARE_SCALE * SQUARE_SCALE;
    let sine = SQUARE_SCALE * cross(n, h);
    let sine2 = select(dot(sine, sine), scale2, noh <= 0.0);
    let a = saturate(noh) * (SQUARE_SCALE * alpha);
    let k = min(scale2 * alpha / max(sine2 + a * a, scale2 * D_FLOOR), 453.5);
    return real(f32(k) * f32(k) * (1.0 / PI));
}

/// Height-correlated Smith visibility, G2 / (4·nov·nol). At nov = nol = 0 the quotient is
/// 0/0; the floor on the denominator keeps 0 ≤ V ≤ 65504 (hard case 1).
fn v_smith_ggx_correlated(nov: real, nol: real, alpha: real) -> real {
    let a2 = alpha * alpha;
    let a = SQUARE_SCALE * alpha;
    let v = SQUARE_SCALE * nov;
    let l = SQUARE_SCALE * nol;
    let lambda_v = nol * sqrt((v - a2 * v) * v + a * a);
    let lambda_l = nov * sqrt((l - a2 * l) * l + a * a);
    return (0.5 * SQUARE_SCALE) / max(lambda_v + lambda_l, SQUARE_SCALE * 7.7e-6);
}

/// Evaluates Hammon's approximation of `v_smith_ggx_correlated` without square roots. It is always
/// low, by 8 % on average and at most 28.5 %. It needs a DFG table built with the same V; otherwise
/// the white furnace test fails twice.
fn v_smith_ggx_correlated_fast(nov: real, nol: real, alpha: real) -> real {
    let l = SQUARE_SCALE * nol;
    let lambda = mix(2.0 * l * nov, l + SQUARE_SCALE * nov, alpha);
    return (0.5 * SQUARE_SCALE) / max(lambda, SQUARE_SCALE * 7.7e-6);
}
