// The standard lit surface: a Lambert layer under a GGX layer, and how it reflects light from
// one direction.

import package::lib::diffuse::fd_lambert;
import package::lib::fresnel::f_schlick;
import package::lib::ggx::{d_ggx, v_smith_ggx_correlated, v_smith_ggx_correlated_fast};

/// What the reflection of a light depends on, apart from the light.
struct StandardSurface {
    /// Unit shading normal.
    normal: vec3<f32>,
    /// Perceptual roughness squared.
    alpha: f32,
    /// Unit vector toward the viewer.
    view: vec3<f32>,
    /// normal · view, at least 1e-4.
    nov: f32,
    /// Albedo of the Lambert layer.
    diffuse: vec3<f32>,
    /// Reflectance at normal incidence.
    f0: vec3<f32>,
    /// Reflectance at grazing incidence: one, but for what KHR_materials_specular weakens.
    f90: f32,
    /// Factor of lib/dfg.wgsl for light scattered more than once.
    compensation: vec3<f32>,
}

/// normal · view, held above 1e-4: interpolated normals may face away from the viewer at a
/// silhouette, and V divides by it (hard case 1).
fn clamp_nov(nov: f32) -> f32 {
    return max(nov, 1e-4);
}

/// BRDF times cosine toward the unit vector `to_light`: multiplied by illuminance it is the
/// reflected radiance. Exactly zero at and behind the horizon (hard case 2). Half-way between
/// opposite vectors lies nothing; the floor keeps h finite there (hard case 7). The Lambert
/// layer does not know what the layer above it took, as in glTF and Filament.
fn reflect_light(s: StandardSurface, to_light: vec3<f32>, fast_visibility: bool) -> vec3<f32> {
    let nol = min(dot(s.normal, to_light), 1.0);
    if !(nol > 0.0) {
        return vec3<f32>(0.0);
    }
    let sum = to_light + s.view;
    let h = sum * inverseSqrt(max(dot(sum, sum), 1e-7));
    let noh = dot(s.normal, h);
    let loh = dot(to_light, h);
    var v = 0.0;
    if fast_visibility {
        v = v_smith_ggx_correlated_fast(s.nov, nol, s.alpha);
    } else {
        v = v_smith_ggx_correlated(s.nov, nol, s.alpha);
    }
    let specular = (d_ggx(noh, s.alpha) * v) * f_schlick(s.f0, s.f90, loh);
    return (s.diffuse * fd_lambert() + specular * s.compensation) * nol;
}
