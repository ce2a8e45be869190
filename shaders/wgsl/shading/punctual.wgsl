// Sums all punctual lights, or with the feature FROXELS only those listed for the froxel. Lights
// out of range contribute zero, so both sums are equal and have the same order.

import package::interface::frame::{
    frame, lights, LightUniforms, LIGHT_DIRECTIONAL, LIGHT_POINT, LIGHT_SPOT,
};
@if(FROXELS)
import package::interface::light_lists::{froxels, light_lists, light_list_at};
import package::lib::numerics::normalize_or;
import package::lib::punctual::{
    distance_attenuation, distance_attenuation_squared, light_far_fade, spot_attenuation,
};
import package::lib::real::real3;
import package::shading::direct::reflect_surface;
import package::shading::object_light::takes_light;
import package::shading::quality::{LIGHT_FADE_INV_FAR2, SQUARED_LIGHT_WINDOW};
import package::shading::shadow::{light_share, light_visibility};
import package::shading::shadow_map::Receiver;
import package::shading::surface::Surface;
@if(DIFFUSE_TRANSMISSION || SUBSURFACE || CLOTH_SUBSURFACE)
import package::shading::through::is_behind;
@if(DIFFUSE_TRANSMISSION)
import package::shading::through::far_side;

/// Enables punctual lights; false removes them from the shader.
override LAMPS: bool = true;

/// Returns the reflected and transmitted radiance of one punctual light.
fn reflect_punctual(s: Surface, light: LightUniforms, receiver: Receiver) -> vec3<f32> {
    if !takes_light(light.channels) {
        return vec3<f32>(0.0);
    }
    if light.kind == LIGHT_DIRECTIONAL {
        return reflect_surface(s, real3(-light.direction)) * light.intensity;
    }
    let to_light = light.position - receiver.world;
    let l = normalize_or(to_light, vec3<f32>(s.base.normal));
    var attenuation = 0.0;
    if SQUARED_LIGHT_WINDOW {
        attenuation = distance_attenuation_squared(dot(to_light, to_light), light.inv_range2);
    } else {
        attenuation = distance_attenuation(dot(to_light, to_light), light.inv_range2);
    }
    if LIGHT_FADE_INV_FAR2 > 0.0 {
        let from_eye = receiver.world - frame.world_from_view[3].xyz;
        attenuation *= light_far_fade(dot(from_eye, from_eye), LIGHT_FADE_INV_FAR2);
    }
    if light.kind == LIGHT_SPOT {
        attenuation *= spot_attenuation(
            dot(light.direction, -l),
            light.spot_scale,
            light.spot_offset,
        );
    }
    if !(attenuation > 0.0) {
        return vec3<f32>(0.0);
    }
    let reflected = reflect_surface(s, real3(l)) * (light.intensity * attenuation);
    if light.shadow_map == 0u || !any(reflected > vec3<f32>(0.0)) {
        return reflected;
    }
    let is_point = light.kind == LIGHT_POINT;
    @if(DIFFUSE_TRANSMISSION) {
        if is_behind(s, l) {
            let lit = far_side(s, receiver);
            let from_light = lit.world - light.position;
            let visible = light_visibility(light.shadow_map, is_point, from_light, lit);
            return reflected * light_share(visible, light.shadow_strength);
        }
    }
    // The back side of an object is in its own shadow, so shadows are ignored there, as in
    // Filament.
    @if(SUBSURFACE || CLOTH_SUBSURFACE) {
        if is_behind(s, l) {
            return reflected;
        }
    }
    let visible = light_visibility(light.shadow_map, is_point, -to_light, receiver);
    return reflected * light_share(visible, light.shadow_strength);
}

/// Returns `radiance` plus the contribution of punctual lights.
@if(FROXELS)
fn add_punctual(radiance: vec3<f32>, s: Surface, receiver: Receiver) -> vec3<f32> {
    var sum = radiance;
    for (var i = 0u; i < froxels.everywhere; i++) {
        sum += reflect_punctual(s, lights[i], receiver);
    }
    let list = light_list_at(receiver.world, receiver.pixel);
    for (var i = list.x; i < list.y; i++) {
        sum += reflect_punctual(s, lights[light_lists[i]], receiver);
    }
    return sum;
}

@else
fn add_punctual(radiance: vec3<f32>, s: Surface, receiver: Receiver) -> vec3<f32> {
    var sum = radiance;
    for (var i = 0u; i < frame.light_count; i++) {
        if LAMPS {
            sum += reflect_punctual(s, lights[i], receiver);
        } else {
            // Never executed, but the shader needs a loop: without any loop, llvmpipe generates
            // code that is up to 1.8 times slower (docs/measurements/performance.md).
            sum += f32(i);
        }
    }
    return sum;
}
