// Reflection and transmission of one light by a surface with all its lobes: BSDF times cosine.

@if(SUBSURFACE || CLOTH_SUBSURFACE)
import package::interface::material::material;
@if(CLEAR_COAT || ANISOTROPY || IRIDESCENCE)
import package::lib::fresnel::{f_schlick, f_schlick_scalar};
@if(ANISOTROPY)
import package::lib::anisotropy::{d_ggx_anisotropic, v_smith_ggx_correlated_anisotropic};
@if(CLEAR_COAT)
import package::lib::clear_coat::v_kelemen;
@if(SHEEN)
import package::lib::cloth::{d_charlie, v_neubelt};
@if(ANISOTROPY || IRIDESCENCE || CLOTH_SUBSURFACE)
import package::lib::diffuse::fd_lambert;
@if(DIFFUSE_TRANSMISSION)
import package::lib::diffuse::fd_transmitted;
@if(CLEAR_COAT || IRIDESCENCE)
import package::lib::ggx::{
    d_ggx, d_ggx_cross, v_smith_ggx_correlated, v_smith_ggx_correlated_fast,
};
import package::lib::real::{real, real3};
import package::lib::standard_surface::{half_vector, reflect_light};
@if(SUBSURFACE)
import package::lib::subsurface::subsurface_scatter;
@if(CLOTH_SUBSURFACE)
import package::lib::subsurface::{cloth_tint, wrapped_cosine};
import package::shading::quality::FAST_VISIBILITY;
import package::shading::surface::Surface;
@if(IRIDESCENCE)
import package::shading::surface::{film_reflectance, largest_channel};
@if(DIFFUSE_TRANSMISSION || SUBSURFACE)
import package::shading::surface::layer_transmittance;

/// Evaluates the isotropic base; for cloth, only its specular layer.
@if(!ANISOTROPY && !IRIDESCENCE)
fn reflect_base(s: Surface, to_light: real3) -> vec3<f32> {
    @if(CLOTH_SUBSURFACE) {
        var specular = s.base;
        specular.diffuse = real3(0.0);
        return reflect_light(specular, to_light, FAST_VISIBILITY);
    }
    @else {
        return reflect_light(s.base, to_light, FAST_VISIBILITY);
    }
}

/// Evaluates D · V of the isotropic base.
@if(!ANISOTROPY && IRIDESCENCE)
fn base_lobe(s: Surface, to_light: real3, h: real3, nol: real) -> f32 {
    let noh = dot(s.base.normal, h);
    @if(HALF)
    let d = d_ggx_cross(s.base.normal, h, noh, s.base.alpha);
    @else
    let d = d_ggx(noh, s.base.alpha);
    var v = real(0.0);
    if FAST_VISIBILITY {
        v = v_smith_ggx_correlated_fast(s.base.nov, nol, s.base.alpha);
    } else {
        v = v_smith_ggx_correlated(s.base.nov, nol, s.base.alpha);
    }
    return f32(d) * f32(v);
}

/// Evaluates D · V of the anisotropic base. It always uses the exact terms, as in Filament, because
/// they have no fast form.
@if(ANISOTROPY)
fn base_lobe(s: Surface, to_light: real3, h: real3, nol: real) -> f32 {
    let t = real3(s.anisotropy.tangent);
    let b = real3(s.anisotropy.bitangent);
    let alpha = s.anisotropy.alpha;
    let d = d_ggx_anisotropic(alpha, dot(t, h), dot(b, h), dot(s.base.normal, h));
    let v = v_smith_ggx_correlated_anisotropic(
        alpha,
        real3(dot(t, s.base.view), dot(b, s.base.view), s.base.nov),
        real3(dot(t, to_light), dot(b, to_light), nol),
    );
    return d * f32(v);
}

/// Evaluates the base with anisotropy or a thin film. Unlike a dielectric interface, a film may
/// reflect most of the light; the diffuse layer receives the rest.
@if(ANISOTROPY || IRIDESCENCE)
fn reflect_base(s: Surface, to_light: real3) -> vec3<f32> {
    let nol = min(dot(s.base.normal, to_light), 1.0);
    if !(nol > 0.0) {
        return vec3<f32>(0.0);
    }
    let h = half_vector(to_light, s.base.view);
    let loh = dot(to_light, h);
    var diffuse = vec3<f32>(s.base.diffuse * fd_lambert());
    @if(CLOTH_SUBSURFACE) diffuse = vec3<f32>(0.0);
    @if(IRIDESCENCE)
    let bare = vec3<f32>(f_schlick(s.film.bare_f0, s.base.f90, loh));
    @if(IRIDESCENCE)
    let film = film_reflectance(s.film, f32(loh));
    @if(IRIDESCENCE)
    let f = mix(bare, film, s.film.factor);
    @else
    let f = vec3<f32>(f_schlick(s.base.f0, s.base.f90, loh));
    @if(IRIDESCENCE)
    diffuse *= 1.0 - s.film.factor * largest_channel(film);
    let specular = base_lobe(s, to_light, h, nol) * f;
    return (diffuse + specular * vec3<f32>(s.base.compensation)) * f32(nol);
}

/// Evaluates light from behind that is scattered through the base and attenuated by the layers
/// above.
@if(DIFFUSE_TRANSMISSION)
fn transmit_light(s: Surface, to_light: real3) -> vec3<f32> {
    let scattered = f32(fd_transmitted(dot(s.base.normal, to_light)));
    var share = layer_transmittance(s);
    @if(IRIDESCENCE)
    share *= 1.0 - s.film.toward_view;
    return vec3<f32>(s.translucency.color) * (scattered * share);
}

/// Evaluates subsurface scattering, attenuated by the layers above.
@if(SUBSURFACE)
fn scatter_light(s: Surface, to_light: real3) -> vec3<f32> {
    let given = material.subsurface;
    let vol = dot(s.base.view, to_light);
    let nol = dot(s.base.normal, to_light);
    let scattered = subsurface_scatter(vol, nol, given.power, given.thickness);
    return given.color * (scattered * layer_transmittance(s));
}

/// Evaluates the Lambert layer of cloth, wrapped around the terminator and tinted there.
@if(CLOTH_SUBSURFACE)
fn reflect_cloth(s: Surface, to_light: real3) -> vec3<f32> {
    let nol = dot(s.base.normal, to_light);
    let tint = cloth_tint(real3(material.subsurface.cloth_color), nol);
    return vec3<f32>(s.base.diffuse * tint * (wrapped_cosine(nol) * fd_lambert()));
}

/// Evaluates only the sheen lobe.
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

/// Returns the coat's reflection in x, and its attenuation of the layers below in y.
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

/// Evaluates BSDF times cosine of the whole surface toward the unit vector `to_light`.
fn reflect_surface(s: Surface, to_light: real3) -> vec3<f32> {
    var reflected = reflect_base(s, to_light);
    @if(CLOTH_SUBSURFACE) reflected += reflect_cloth(s, to_light);
    @if(SHEEN)
    reflected = reflected * f32(s.sheen.attenuation) + reflect_sheen(s, to_light);
    @if(CLEAR_COAT) {
        let coat = reflect_coat(s, to_light);
        reflected = reflected * (1.0 - coat.y) + vec3<f32>(coat.x);
    }
    @if(DIFFUSE_TRANSMISSION) reflected += transmit_light(s, to_light);
    @if(SUBSURFACE) reflected += scatter_light(s, to_light);
    return reflected;
}
