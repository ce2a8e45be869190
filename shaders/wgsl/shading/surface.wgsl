// A surface with its lobes: what shading needs of the material at one point.
//
// A lobe is there only under its feature, so a surface without it carries and computes nothing
// of it. Layers from the top: clear coat, sheen, then GGX over Lambert.

@if(CLEAR_COAT)
import package::lib::clear_coat::{
    f0_under_clear_coat, f0_under_clear_coat_fast, roughness_under_clear_coat,
};
@if(ANISOTROPY)
import package::lib::normal_map::duff_tangent;
@if(ANISOTROPY)
import package::lib::numerics::{normalize_or, DEGENERATE_LENGTH2};
import package::lib::real::{real, real2, real3};
import package::lib::standard_surface::StandardSurface;
@if(CLEAR_COAT)
import package::shading::quality::FAST_COAT;

/// Clear coat: a dielectric layer of index 1.5 over the other lobes.
@if(CLEAR_COAT)
struct ClearCoat {
    /// Unit normal: its own map's, not the base's.
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
    /// Share of the light that the layers below receive and give off, 0…1.
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
    /// Roughness of the microfacet distribution along the two.
    alpha: real2,
    /// Strength of the anisotropy, 0…1.
    strength: f32,
}

/// A surface with all its lobes.
struct Surface {
    base: StandardSurface,
    @if(CLEAR_COAT)
    coat: ClearCoat,
    @if(SHEEN)
    sheen: Sheen,
    @if(ANISOTROPY)
    anisotropy: Anisotropy,
}

/// f0 of the base under a coat of this strength: no more than in air, since an f0 near zero says
/// that nothing is reflected, and not that the base has the index of air.
@if(CLEAR_COAT)
fn coated_f0(f0: real3, strength: real) -> real3 {
    var under = real3(0.0);
    if FAST_COAT {
        under = f0_under_clear_coat_fast(f0);
    } else {
        under = f0_under_clear_coat(f0);
    }
    return mix(f0, min(under, f0), strength);
}

/// Perceptual roughness of the base under a coat of this strength and roughness.
@if(CLEAR_COAT)
fn coated_roughness(base: f32, coat: f32, strength: f32) -> f32 {
    return f32(roughness_under_clear_coat(real(base), real(coat), real(strength)));
}

/// Unit direction of anisotropy in world space. `turn` is it as (tangent, bitangent) components,
/// `tangent` the mesh's with its handedness in w, `front` the unit normal of the
/// front side. A tangent that spans nothing is replaced by Duff's.
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
