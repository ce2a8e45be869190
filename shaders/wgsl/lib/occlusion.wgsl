// Ambient occlusion for diffuse and specular light.
//
// Visibility is the share of the cosine-weighted hemisphere that is not occluded. Diffuse light
// takes it as it is, or brightened by interreflection; a specular lobe sees only part of the
// hemisphere and needs an estimate of its own.

import package::lib::math::PI;

/// Ambient occlusion with interreflection between surfaces of the given albedo (Jiménez et
/// al., "Practical Real-Time Strategies for Accurate Indirect Occlusion", 2016). Never darker
/// than the input; albedo is clamped, since above one the polynomial leaves [0, 1] (hard case
/// 29). Against a spherical cavity its RMS error is 0.077, where ignoring bounces has 0.211.
fn gtao_multi_bounce(visibility: f32, albedo: vec3<f32>) -> vec3<f32> {
    let p = saturate(albedo);
    let v = vec3<f32>(saturate(visibility));
    let a = 2.0404 * p - 0.3324;
    let b = -4.7951 * p + 0.6417;
    let c = 2.7552 * p + 0.6903;
    return min(max(v, ((v * a + b) * v + c) * v), vec3<f32>(1.0));
}

/// Returns specular occlusion from ambient occlusion alone (Lagarde and de Rousiers, "Moving
/// Frostbite to PBR", 2014, listing 26). Rough lobes follow the occlusion; smooth lobes ignore it
/// unless it is nearly complete.
fn specular_occlusion(nov: f32, visibility: f32, alpha: f32) -> f32 {
    let open = max(nov + visibility, 0.0);
    return saturate(pow(open, exp2(-16.0 * alpha - 1.0)) - 1.0 + visibility);
}

/// Returns the solid angle of the intersection of two spherical caps, over 2π. Caps are given by
/// the cosines of their half angles, `cos_distance` is that between their axes. A smoothstep
/// interpolates between touching and containing (Oat and Sander, "Ambient Aperture Lighting",
/// 2007).
fn spherical_caps_overlap(cos_cap1: f32, cos_cap2: f32, cos_distance: f32) -> f32 {
    let r1 = acos(clamp(cos_cap1, -1.0, 1.0));
    let r2 = acos(clamp(cos_cap2, -1.0, 1.0));
    let d = acos(clamp(cos_distance, -1.0, 1.0));
    let smaller = 1.0 - max(cos_cap1, cos_cap2);
    let contained = abs(r1 - r2);
    let x = 1.0 - saturate((d - contained) / max(r1 + r2 - contained, 1e-4));
    return smaller * x * x * (3.0 - 2.0 * x);
}

/// Returns specular occlusion from a bent normal: the intersection of the open cone around it with
/// the lobe's cone around the reflected direction r (Jiménez et al. 2016). For mirrors, whose cone
/// has no width, it fades to one between alpha 0.01 and 0.09.
fn specular_occlusion_cones(
    bent_normal: vec3<f32>,
    r: vec3<f32>,
    visibility: f32,
    alpha: f32,
) -> f32 {
    let cos_open = sqrt(1.0 - saturate(visibility));
    // 10^(-alpha²): the cone that holds most of the lobe.
    let cos_lobe = exp2(-3.321928 * alpha * alpha);
    let overlap = spherical_caps_overlap(cos_open, cos_lobe, dot(bent_normal, r));
    let occlusion = saturate(overlap / max(1.0 - cos_lobe, 1e-6));
    return mix(1.0, occlusion, smoothstep(0.01, 0.09, alpha));
}

/// Returns the share of a reflection that remains when a normal map turns it below the geometric
/// horizon: 1 at and above the horizon, falling to 0 straight down. `normal` is the interpolated
/// normal without the normal map.
fn horizon_occlusion(r: vec3<f32>, normal: vec3<f32>) -> f32 {
    let h = saturate(1.0 + dot(r, normal));
    return h * h;
}
