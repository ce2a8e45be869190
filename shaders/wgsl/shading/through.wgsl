// Light transmitted through a surface: refracted or scattered.

@if(TRANSMISSION || DIFFUSE_TRANSMISSION)
import package::interface::material::material;
@if(TRANSMISSION)
import package::interface::scene::radiance_behind;
import package::lib::real::real3;
@if(TRANSMISSION && DISPERSION)
import package::lib::refraction::dispersed_ior;
@if(TRANSMISSION)
import package::lib::refraction::{
    refracted_path, seen_transmission_spread, transmission_spread,
};
@if(TRANSMISSION || DIFFUSE_TRANSMISSION)
import package::lib::refraction::transmittance;
@if(TRANSMISSION)
import package::shading::quality::TRANSMISSION_BY_ANGLE;
@if(DIFFUSE_TRANSMISSION)
import package::shading::shadow_map::Receiver;
@if(DIFFUSE_TRANSMISSION || SUBSURFACE || CLOTH_SUBSURFACE)
import package::shading::surface::Surface;
@if(DIFFUSE_TRANSMISSION)
import package::shading::surface::Translucency;

/// Returns pre-exposed radiance refracted through an object with one index of refraction.
/// `thickness_m` is 0 for a thin wall; `roughness` is the material's, without specular
/// antialiasing.
@if(TRANSMISSION)
fn refract_by(
    world: vec3<f32>,
    view: vec3<f32>,
    normal: vec3<f32>,
    alpha: f32,
    roughness: f32,
    thickness_m: f32,
    ior: f32,
) -> vec3<f32> {
    let path = refracted_path(view, normal, ior, thickness_m);
    var spread_rad = vec2<f32>(transmission_spread(alpha, ior), 0.0);
    if TRANSMISSION_BY_ANGLE {
        spread_rad = vec2<f32>(0.0, seen_transmission_spread(roughness, ior));
    }
    return radiance_behind(world, path, ior, spread_rad)
        * transmittance(material.transmission.absorption, length(path));
}

/// Returns pre-exposed radiance refracted through the object; with dispersion, each channel has its
/// own index.
@if(TRANSMISSION)
fn refract_scene(
    world: vec3<f32>,
    view: vec3<f32>,
    normal: vec3<f32>,
    alpha: f32,
    roughness: f32,
    thickness_m: f32,
) -> vec3<f32> {
    let ior = material.transmission.ior;
    @if(DISPERSION) {
        let iors = dispersed_ior(ior, material.transmission.dispersion);
        return vec3<f32>(
            refract_by(world, view, normal, alpha, roughness, thickness_m, iors.r).r,
            refract_by(world, view, normal, alpha, roughness, thickness_m, iors.g).g,
            refract_by(world, view, normal, alpha, roughness, thickness_m, iors.b).b,
        );
    }
    @else {
        return refract_by(world, view, normal, alpha, roughness, thickness_m, ior);
    }
}

/// Returns the transmitted diffuse light of a fragment; `lambert` is its share of the Lambert
/// layer.
@if(DIFFUSE_TRANSMISSION)
fn translucency_of(albedo: vec3<f32>, lambert: f32, thickness_m: f32) -> Translucency {
    let left = transmittance(material.transmission.absorption, thickness_m);
    return Translucency(real3(saturate(albedo) * (lambert * left)), thickness_m);
}

/// Returns true if a light in this direction is behind the surface.
@if(DIFFUSE_TRANSMISSION || SUBSURFACE || CLOTH_SUBSURFACE)
fn is_behind(s: Surface, to_light: vec3<f32>) -> bool {
    return dot(vec3<f32>(s.base.normal), to_light) < 0.0;
}

/// Returns the shadow receiver for lights from behind: the far side of the object, `depth_m` below
/// the surface. The normal is flipped, because an offset away from the light would cause
/// self-shadowing.
@if(DIFFUSE_TRANSMISSION)
fn far_side(s: Surface, receiver: Receiver) -> Receiver {
    var far = receiver;
    far.normal = -receiver.normal;
    far.world = receiver.world + far.normal * s.translucency.depth_m;
    return far;
}
