// Light of all punctual lights: of every one, or with the feature FROXELS of those alone that are
// listed for the place. A light adds nothing where it does not reach, so both are the same sum in
// the same order.

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

/// Whether there are punctual lights: without them, what they reflect is no part of the shader.
override LAMPS: bool = true;

/// Radiance reflected from one punctual light, and let through.
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
    // A body shadows the side of it that faces away from the light: no shadow falls there, as in
    // Filament.
    @if(SUBSURFACE || CLOTH_SUBSURFACE) {
        if is_behind(s, l) {
            return reflected;
        }
    }
    let visible = light_visibility(light.shadow_map, is_point, -to_light, receiver);
    return reflected * light_share(visible, light.shadow_strength);
}

/// `radiance` with what punctual lights add to it.
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
            // Never, but something has to be in the loop: of a shader without any loop llvmpipe
            // makes code that takes up to 1.8 times as long (docs/measurements/performance.md).
            sum += f32(i);
        }
    }
    return sum;
}
