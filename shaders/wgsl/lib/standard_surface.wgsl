// The standard lit surface: a Lambert layer under a GGX layer, and how it reflects light from
// one direction.

import package::lib::diffuse::fd_lambert;
import package::lib::fresnel::f_schlick;
import package::lib::ggx::{
    d_ggx, d_ggx_cross, v_smith_ggx_correlated, v_smith_ggx_correlated_fast,
};
import package::lib::real::{real, real3};

/// Surface parameters of the BRDF that do not depend on the light.
struct StandardSurface {
    /// Unit shading normal.
    normal: real3,
    /// Perceptual roughness squared.
    alpha: real,
    /// Unit vector toward the viewer.
    view: real3,
    /// normal · view, at least 1e-4.
    nov: real,
    /// Albedo of the Lambert layer.
    diffuse: real3,
    /// Reflectance at normal incidence.
    f0: real3,
    /// Reflectance at grazing incidence: one, but for what KHR_materials_specular weakens.
    f90: real,
    /// Factor of lib/dfg.wgsl for light scattered more than once.
    compensation: real3,
}

/// normal · view, held above 1e-4: interpolated normals may face away from the viewer at a
/// silhouette, and V divides by it (hard case 1).
fn clamp_nov(nov: real) -> real {
    return max(nov, 1e-4);
}

/// Returns the unit vector half-way between two unit vectors. The lower limit of the length keeps
/// the result finite for opposite vectors, and at most 1 (hard case 7). Always f32, because the
/// squared length of nearly opposite vectors underflows half floats.
fn half_vector(a: real3, b: real3) -> real3 {
    let sum = vec3<f32>(a) + vec3<f32>(b);
    return real3(sum * inverseSqrt(max(dot(sum, sum), 1e-12)));
}

/// BRDF times cosine toward the unit vector `to_light`: multiplied by illuminance it is the
/// reflected radiance. Exactly zero at and behind the horizon (hard case 2). The Lambert layer does
/// not know what the layer above it took, as in glTF and Filament. Half floats hold each factor but
/// not D · V, so those are put together in f32.
fn reflect_light(s: StandardSurface, to_light: real3, fast_visibility: bool) -> vec3<f32> {
    let nol = min(dot(s.normal, to_light), 1.0);
    if !(nol > 0.0) {
        return vec3<f32>(0.0);
    }
    let h = half_vector(to_light, s.view);
    let noh = dot(s.normal, h);
    let loh = dot(to_light, h);
    @if(HALF)
    let d = d_ggx_cross(s.normal, h, noh, s.alpha);
    @else
    let d = d_ggx(noh, s.alpha);
    var v = real(0.0);
    if fast_visibility {
        v = v_smith_ggx_correlated_fast(s.nov, nol, s.alpha);
    } else {
        v = v_smith_ggx_correlated(s.nov, nol, s.alpha);
    }
    let specular = (f32(d) * f32(v)) * vec3<f32>(f_schlick(s.f0, s.f90, loh));
    let diffuse = vec3<f32>(s.diffuse * fd_lambert());
    return (diffuse + specular * vec3<f32>(s.compensation)) * f32(nol);
}
