// What a surface with all its lobes reflects of one light: BRDF times cosine.

@if(CLEAR_COAT || ANISOTROPY)
import package::lib::fresnel::{f_schlick, f_schlick_scalar};
@if(ANISOTROPY)
import package::lib::anisotropy::{d_ggx_anisotropic, v_smith_ggx_correlated_anisotropic};
@if(CLEAR_COAT)
import package::lib::clear_coat::v_kelemen;
@if(SHEEN)
import package::lib::cloth::{d_charlie, v_neubelt};
@if(ANISOTROPY)
import package::lib::diffuse::fd_lambert;
@if(CLEAR_COAT)
import package::lib::ggx::{d_ggx, d_ggx_cross};
import package::lib::real::{real, real3};
import package::lib::standard_surface::{half_vector, reflect_light};
import package::shading::quality::FAST_VISIBILITY;
import package::shading::surface::Surface;

/// The isotropic base.
@if(!ANISOTROPY)
fn reflect_base(s: Surface, to_light: real3) -> vec3<f32> {
    return reflect_light(s.base, to_light, FAST_VISIBILITY);
}

/// The anisotropic base: the exact anisotropic terms whatever the quality, as Filament does; there
/// is no fast form of them.
@if(ANISOTROPY)
fn reflect_base(s: Surface, to_light: real3) -> vec3<f32> {
    let nol = min(dot(s.base.normal, to_light), 1.0);
    if !(nol > 0.0) {
        return vec3<f32>(0.0);
    }
    let h = half_vector(to_light, s.base.view);
    let t = real3(s.anisotropy.tangent);
    let b = real3(s.anisotropy.bitangent);
    let alpha = s.anisotropy.alpha;
    let d = d_ggx_anisotropic(alpha, dot(t, h), dot(b, h), dot(s.base.normal, h));
    let v = v_smith_ggx_correlated_anisotropic(
        alpha,
        real3(dot(t, s.base.view), dot(b, s.base.view), s.base.nov),
        real3(dot(t, to_light), dot(b, to_light), nol),
    );
    let f = f_schlick(s.base.f0, s.base.f90, dot(to_light, h));
    let specular = (d * f32(v)) * vec3<f32>(f);
    let diffuse = vec3<f32>(s.base.diffuse * fd_lambert());
    return (diffuse + specular * vec3<f32>(s.base.compensation)) * f32(nol);
}

/// The sheen lobe alone.
@if(SHEEN)
fn reflect_sheen(s: Surface, to_light: real3) -> vec3<f32> {
    let nol = min(dot(s.base.normal, to_light), 1.0);
    if !(nol > 0.0) {
        return vec3<f32>(0.0);
    }
    let noh = dot(s.base.normal, half_vector(to_light, s.base.view));
    let d = d_charlie(noh, s.sheen.alpha);
    let v = v_neubelt(s.base.nov, nol);
    return vec3<f32>(s.sheen.color) * (f32(d) * f32(v) * f32(nol));
}

/// The coat alone in x, and in y the share that it takes from what is below.
@if(CLEAR_COAT)
fn reflect_coat(s: Surface, to_light: real3) -> vec2<f32> {
    let h = half_vector(to_light, s.base.view);
    let loh = dot(to_light, h);
    let fresnel = f32(f_schlick_scalar(0.04, 1.0, loh) * s.coat.strength);
    let normal = real3(s.coat.normal);
    let nol = min(dot(normal, to_light), 1.0);
    if !(nol > 0.0) {
        return vec2<f32>(0.0, fresnel);
    }
    let noh = dot(normal, h);
    @if(HALF)
    let d = d_ggx_cross(normal, h, noh, s.coat.alpha);
    @else
    let d = d_ggx(noh, s.coat.alpha);
    return vec2<f32>(f32(d) * f32(v_kelemen(loh)) * fresnel * f32(nol), fresnel);
}

/// BRDF times cosine of the whole surface toward the unit vector `to_light`.
fn reflect_surface(s: Surface, to_light: real3) -> vec3<f32> {
    var reflected = reflect_base(s, to_light);
    @if(SHEEN)
    reflected = reflected * f32(s.sheen.attenuation) + reflect_sheen(s, to_light);
    @if(CLEAR_COAT) {
        let coat = reflect_coat(s, to_light);
        reflected = reflected * (1.0 - coat.y) + vec3<f32>(coat.x);
    }
    return reflected;
}
