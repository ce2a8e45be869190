// Anisotropic GGX: of different roughness along tangent and bitangent, as brushed metal.
//
// Burley, "Physically Based Shading at Disney", 2012 (the stretched distribution); Heitz,
// "Understanding the Masking-Shadowing Function", JCGT 2014 (its height-correlated Smith term).
//
// alpha = (along the tangent, along the bitangent). Dots with t, b and n are components of one
// unit vector. The distribution is computed in f32 in every build: at alpha = 0.002 its squares
// are 1e-11, which no half float holds (hard case 11).

import package::lib::math::PI;
import package::lib::ggx::SQUARE_SCALE;
import package::lib::real::{real, real2, real3};

/// Returns alpha along tangent and bitangent, for an isotropic alpha and an anisotropy in [-1, 1].
/// Positive values stretch the highlight along the bitangent. Both are clamped to [floor, 1].
fn anisotropic_alpha(alpha: real, anisotropy: real, floor: real) -> real2 {
    let a = clamp(anisotropy, -1.0, 1.0);
    return clamp(alpha * real2(1.0 + a, 1.0 - a), real2(floor), real2(1.0));
}

/// Returns alpha along tangent and bitangent, as specified in KHR_materials_anisotropy. A strength
/// in [0, 1] increases the roughness along the tangent, the direction of anisotropy.
fn gltf_anisotropic_alpha(alpha: real, strength: real, floor: real) -> real2 {
    let s = saturate(strength);
    let along_tangent = mix(alpha, 1.0, s * s);
    return clamp(real2(along_tangent, alpha), real2(floor), real2(1.0));
}

/// Evaluates the anisotropic GGX distribution of the half vector, in 1/sr. Always finite; no alpha
/// of roughness 0.045 or more reaches the floor.
fn d_ggx_anisotropic(alpha: real2, toh: real, boh: real, noh: real) -> f32 {
    let a = vec2<f32>(alpha);
    let area = a.x * a.y;
    let d = vec3<f32>(a.y * f32(toh), a.x * f32(boh), area * f32(noh));
    let w = area / max(dot(d, d), 1e-12);
    return area * w * w * (1.0 / PI);
}

/// Evaluates height-correlated Smith visibility of the anisotropic lobe. `v` and `l` are the
/// directions to viewer and light as (t, b, n) components, n ≥ 1e-4 for the viewer and > 0 for the
/// light.
fn v_smith_ggx_correlated_anisotropic(alpha: real2, v: real3, l: real3) -> real {
    let lambda_v = l.z * length(SQUARE_SCALE * real3(alpha * v.xy, v.z));
    let lambda_l = v.z * length(SQUARE_SCALE * real3(alpha * l.xy, l.z));
    return (0.5 * SQUARE_SCALE) / max(lambda_v + lambda_l, SQUARE_SCALE * 7.7e-6);
}

/// Returns the normal for reflection from an isotropic prefiltered environment, not normalized. It
/// is bent toward the plane of view direction and `across`, more for rougher surfaces. `across` is
/// the unit direction of the lower roughness: the bitangent for a positive anisotropy, the tangent
/// for a negative one. For a view along `across` the normal is unchanged.
fn anisotropic_bent_normal(
    n: vec3<f32>,
    across: vec3<f32>,
    v: vec3<f32>,
    anisotropy: f32,
    roughness: f32,
) -> vec3<f32> {
    let toward = cross(cross(across, v), across);
    let length2 = dot(toward, toward);
    if length2 < 1e-8 {
        return n;
    }
    let bend = abs(clamp(anisotropy, -1.0, 1.0)) * saturate(5.0 * roughness);
    return mix(n, toward * inverseSqrt(length2), bend);
}
