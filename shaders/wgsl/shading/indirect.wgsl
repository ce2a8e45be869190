// What a surface with all its lobes reflects of the environment.

import package::interface::material::{material, occlusion};
@if(ANISOTROPY)
import package::lib::anisotropy::anisotropic_bent_normal;
import package::lib::dfg::{specular_albedo, energy_compensation};
import package::lib::environment::specular_dominant_direction;
@if(CLEAR_COAT)
import package::lib::fresnel::f_schlick_scalar;
import package::lib::numerics::normalize_or;
import package::lib::occlusion::{gtao_multi_bounce, specular_occlusion};
import package::lib::real::{real, real2};
import package::lib::standard_surface::StandardSurface;
import package::shading::ambient::{ambient_irradiance, ambient_radiance};
import package::shading::quality::{
    ENERGY_COMPENSATION, MULTI_BOUNCE_OCCLUSION, SPECULAR_OCCLUSION,
};
import package::shading::surface::Surface;

/// How much of the ambient light arrives.
struct Openness {
    /// At the Lambert layer.
    diffuse: vec3<f32>,
    /// At the GGX layer.
    specular: vec3<f32>,
    /// As the texture has it, 0…1.
    ambient: f32,
}

/// What a lobe sees where this share of the hemisphere is open.
fn lobe_openness(nov: f32, ambient: f32, alpha: f32) -> f32 {
    if SPECULAR_OCCLUSION {
        return specular_occlusion(nov, ambient, alpha);
    }
    return 1.0;
}

/// From the occlusion texture, as the quality of shading has it.
fn openness(s: StandardSurface, uv: vec4<f32>) -> Openness {
    if material.occlusion_map.present == 0u {
        return Openness(vec3<f32>(1.0), vec3<f32>(1.0), 1.0);
    }
    let open = saturate(occlusion(uv));
    let specular = lobe_openness(f32(s.nov), open, f32(s.alpha));
    if MULTI_BOUNCE_OCCLUSION {
        return Openness(
            gtao_multi_bounce(open, vec3<f32>(s.diffuse)),
            gtao_multi_bounce(specular, vec3<f32>(s.f0)),
            open,
        );
    }
    return Openness(vec3<f32>(open), vec3<f32>(specular), open);
}

/// Radiance that the base reflects; `normal` and `view` are those of the surface, in f32 since a
/// mirror shows what rounding them does.
fn reflect_environment(
    s: Surface,
    normal: vec3<f32>,
    view: vec3<f32>,
    roughness: f32,
    dfg: real2,
    open: Openness,
) -> vec3<f32> {
    let albedo = specular_albedo(s.base.f0, s.base.f90, dfg);
    // Grooves stretch the lobe; a bent normal lets an isotropic one stand in for it.
    @if(ANISOTROPY)
    let grooves = s.grooves;
    @if(ANISOTROPY)
    let across = anisotropic_bent_normal(
        normal,
        grooves.bitangent,
        view,
        grooves.strength,
        roughness,
    );
    @if(ANISOTROPY)
    let about = normalize_or(across, normal);
    @else
    let about = normal;
    let r = reflect(-view, about);
    let dominant = specular_dominant_direction(normal, r, f32(s.base.alpha));
    var gathered = vec3<f32>(albedo) * ambient_radiance(normalize_or(dominant, normal), roughness);
    if ENERGY_COMPENSATION {
        gathered *= vec3<f32>(energy_compensation(s.base.f0, dfg.y));
    }
    let diffuse = vec3<f32>(s.base.diffuse * (1.0 - albedo)) * ambient_irradiance(normal);
    return diffuse * open.diffuse + gathered * open.specular;
}

/// What leaves the surface where `below` comes from its base and the environment shines on its
/// layers: sheen, and over it the coat.
fn cover(
    s: Surface,
    normal: vec3<f32>,
    view: vec3<f32>,
    below: vec3<f32>,
    open: Openness,
) -> vec3<f32> {
    var leaving = below;
    @if(SHEEN) {
        let fibers = s.sheen;
        let r = reflect(-view, normal);
        let seen = lobe_openness(f32(s.base.nov), open.ambient, f32(fibers.alpha));
        let gathered = ambient_radiance(r, fibers.roughness) * (f32(fibers.albedo) * seen);
        leaving = leaving * f32(fibers.attenuation) + vec3<f32>(fibers.color) * gathered;
    }
    @if(CLEAR_COAT) {
        let coat = s.coat;
        let fresnel = f32(f_schlick_scalar(0.04, 1.0, coat.nov) * coat.strength);
        let seen = lobe_openness(f32(coat.nov), open.ambient, f32(coat.alpha));
        let gathered = ambient_radiance(reflect(-view, coat.normal), coat.roughness);
        leaving = leaving * (1.0 - fresnel) + gathered * (fresnel * seen);
    }
    return leaving;
}

/// Share of what the base emits that its layers let out.
fn let_out(s: Surface) -> f32 {
    var share = 1.0;
    @if(SHEEN) share *= f32(s.sheen.attenuation);
    @if(CLEAR_COAT)
    share *= 1.0 - f32(f_schlick_scalar(0.04, 1.0, s.coat.nov) * s.coat.strength);
    return share;
}
