// Surface with its lobes: the material inputs of shading at one point.
//
// Each lobe exists only with its feature and costs nothing without it. Layers from the top: clear
// coat, sheen, then GGX over Lambert, whose reflectance a thin film changes. Light from behind is
// scattered through the Lambert layer.

@if(CLEAR_COAT)
import package::interface::material::{TRAIT_COAT_KEEPS_F0, material_has};
@if(CLEAR_COAT)
import package::lib::clear_coat::{
    f0_under_clear_coat, f0_under_clear_coat_fast, roughness_under_clear_coat,
};
@if(CLEAR_COAT)
import package::lib::fresnel::f_schlick_scalar;
@if(ANISOTROPY)
import package::lib::normal_map::duff_tangent;
@if(ANISOTROPY)
import package::lib::numerics::{normalize_or, DEGENERATE_LENGTH2};
import package::lib::real::{real, real2, real3};
import package::lib::standard_surface::StandardSurface;
@if(IRIDESCENCE)
import package::lib::thin_film::thin_film_reflectance;
@if(CLEAR_COAT)
import package::shading::quality::{FAST_COAT, COAT_IOR_CHANGE};

/// Clear coat: a dielectric layer of index 1.5 over the other lobes.
@if(CLEAR_COAT)
struct ClearCoat {
    /// Unit normal of the coat, from its own normal map.
    normal: vec3<f32>,
    /// normal · view, at least 1e-4.
    nov: real,
    /// Coverage of the surface by the coat, 0…1.
    strength: real,
    /// Perceptual roughness, 0…1.
    roughness: f32,
    /// Roughness of the microfacet distribution: the square of the perceptual one.
    alpha: real,
}

/// Sheen: a cloth lobe over the base.
@if(SHEEN)
struct Sheen {
    /// Reflectance of the lobe, linear Rec.709.
    color: real3,
    /// Directional albedo of the lobe for color one.
    albedo: real,
    /// Attenuation of the layers below, 0…1.
    attenuation: real,
    /// Perceptual roughness, 0…1.
    roughness: f32,
    /// Roughness of the microfacet distribution: the square of the perceptual one.
    alpha: real,
}

/// Anisotropy of the base lobe.
@if(ANISOTROPY)
struct Anisotropy {
    /// Unit vectors perpendicular to the normal: along and across the direction of anisotropy, in
    /// which the lobe is wider.
    tangent: vec3<f32>,
    bitangent: vec3<f32>,
    /// Roughness of the microfacet distribution along `tangent` and `bitangent`.
    alpha: real2,
    /// Strength of the anisotropy, 0…1.
    strength: f32,
}

/// A thin film over the base.
@if(IRIDESCENCE)
struct ThinFilm {
    /// Coverage of the base by the film, 0…1.
    factor: f32,
    /// Index of refraction of the film, 1 or more.
    ior: f32,
    /// Thickness of the film in nm.
    thickness_nm: f32,
    /// Reflectance of the base at normal incidence, without the film.
    base_f0: vec3<f32>,
    /// Factor on the film's reflectance: that of KHR_materials_specular on dielectrics.
    weight: f32,
    /// f0 of the base without the film.
    bare_f0: real3,
    /// Largest channel of the reflectance toward the viewer, by film coverage.
    toward_view: f32,
}

/// Light that is scattered through the surface from behind.
@if(DIFFUSE_TRANSMISSION)
struct Translucency {
    /// Albedo of the transmitted light, including absorption in the volume.
    color: real3,
    /// Depth under the surface at which the light enters, in m; 0 for a thin sheet.
    depth_m: f32,
}

/// Surface with all its lobes.
struct Surface {
    base: StandardSurface,
    @if(CLEAR_COAT)
    coat: ClearCoat,
    @if(SHEEN)
    sheen: Sheen,
    @if(ANISOTROPY)
    anisotropy: Anisotropy,
    @if(IRIDESCENCE)
    film: ThinFilm,
    @if(DIFFUSE_TRANSMISSION)
    translucency: Translucency,
}

/// Returns the reflectance of film and base at the angle whose cosine is `cosine`.
@if(IRIDESCENCE)
fn film_reflectance(film: ThinFilm, cosine: f32) -> vec3<f32> {
    return thin_film_reflectance(cosine, film.ior, film.thickness_nm, film.base_f0) * film.weight;
}

/// Returns the largest channel of a color. Attenuating all channels by it preserves the hue of the
/// rest.
@if(IRIDESCENCE)
fn largest_channel(color: vec3<f32>) -> f32 {
    return max(color.x, max(color.y, color.z));
}

/// Returns the share of light that passes the base's specular layer with directional albedo
/// `albedo`. Under a film, all channels use the largest albedo, which avoids complementary hues.
@if(IRIDESCENCE)
fn share_below(s: Surface, albedo: real3) -> real3 {
    let most = real(largest_channel(vec3<f32>(albedo)));
    return 1.0 - mix(albedo, real3(most), real(s.film.factor));
}

/// Returns the transmittance of the layers above the base, 0…1, which attenuates emission.
fn layer_transmittance(s: Surface) -> f32 {
    var share = 1.0;
    @if(SHEEN) share *= f32(s.sheen.attenuation);
    @if(CLEAR_COAT)
    share *= 1.0 - f32(f_schlick_scalar(0.04, 1.0, s.coat.nov) * s.coat.strength);
    return share;
}

/// Returns f0 of the base under a coat of this strength. It never exceeds f0 in air, because f0
/// near zero means no reflection rather than the index of air.
@if(CLEAR_COAT)
fn coated_f0(f0: real3, strength: real) -> real3 {
    if !COAT_IOR_CHANGE || material_has(TRAIT_COAT_KEEPS_F0) {
        return f0;
    }
    var under = real3(0.0);
    if FAST_COAT {
        under = f0_under_clear_coat_fast(f0);
    } else {
        under = f0_under_clear_coat(f0);
    }
    return mix(f0, min(under, f0), strength);
}

/// Returns the perceptual roughness of the base under a coat of this strength and roughness.
@if(CLEAR_COAT)
fn coated_roughness(base: f32, coat: f32, strength: f32) -> f32 {
    return f32(roughness_under_clear_coat(real(base), real(coat), real(strength)));
}

/// Returns the unit direction of anisotropy in world space. `turn` is the direction in (tangent,
/// bitangent) components, `tangent` is the mesh's with handedness in w, and `front` is the unit
/// normal of the front side. Duff's tangent replaces a degenerate one.
@if(ANISOTROPY)
fn anisotropy_direction(normal: vec3<f32>, front: vec3<f32>, tangent: vec4<f32>, turn: vec2<f32>)
    -> vec3<f32>
{
    var t = tangent.xyz - normal * dot(normal, tangent.xyz);
    if dot(t, t) < DEGENERATE_LENGTH2 {
        t = duff_tangent(normal);
    }
    t = normalize_or(t, vec3<f32>(1.0, 0.0, 0.0));
    let b = cross(front, t) * tangent.w;
    return normalize_or(t * turn.x + (b - normal * dot(normal, b)) * turn.y, t);
}
