// Visibility of lights by their shadow maps.
//
// SHADOWS reads depth with a tent filter, SHADOW_SOFT reads depth with penumbrae, and
// SHADOW_MOMENTS reads moments. Without these features, lights cast no shadows.

import package::interface::shadow::{
    shadow, local_maps, ShadowMapUniforms, CASCADES, SHADOWS_END, LAMP_SHADOWS, WEAK_SHADOWS,
    SHOW_CASCADES,
};
import package::lib::shadow::{
    normal_offset, shadow_uvz_from_clip, cascade_at, faded_visibility, weakened_visibility,
    cube_face_of,
};
@if(SHADOWS && !SHADOW_SOFT && !SHADOW_MOMENTS)
import package::shading::shadow_depth::tent_visibility;
@if(SHADOW_SOFT && !SHADOW_MOMENTS)
import package::shading::shadow_depth::soft_visibility;
import package::shading::object_light::receives_shadows;
import package::shading::shadow_map::{Receiver, ahead_m, texel_scale};
@if(SHADOW_MOMENTS)
import package::shading::shadow_moments::moments_visibility;

/// Returns the visibility of the sun, 0…1.
@if(SHADOWS || SHADOW_SOFT || SHADOW_MOMENTS)
fn sun_visibility(receiver: Receiver) -> f32 {
    if !receives_shadows() {
        return 1.0;
    }
    let ahead = ahead_m(receiver.world);
    // The index of a single cascade is a constant; shadows have faded out at its end.
    let cascade = select(cascade_at(ahead, shadow.far_ends), 0u, CASCADES == 1u);
    if cascade >= CASCADES {
        return 1.0;
    }
    var map = shadow.cascades[min(cascade, CASCADES - 1u)];
    // Every cascade fills the layer of its index, so these are constants, too.
    map.uv_scale = 1.0;
    map.layer = min(cascade, CASCADES - 1u);
    let visibility = map_visibility(map, receiver);
    return select(visibility, faded_visibility(visibility, ahead, shadow.inv_far2), SHADOWS_END);
}

@else
fn sun_visibility(receiver: Receiver) -> f32 {
    return 1.0;
}

/// Returns the share of sunlight for this visibility, with the shadow strength applied.
@if(SHADOWS || SHADOW_SOFT || SHADOW_MOMENTS)
fn sun_share(visibility: f32) -> f32 {
    if !WEAK_SHADOWS {
        return visibility;
    }
    return weakened_visibility(visibility, shadow.sun_strength);
}

@else
fn sun_share(visibility: f32) -> f32 {
    return visibility;
}

/// Returns the share of a punctual light for this visibility, with the shadow strength applied.
@if(SHADOWS || SHADOW_SOFT || SHADOW_MOMENTS)
fn light_share(visibility: f32, strength: f32) -> f32 {
    if !WEAK_SHADOWS {
        return visibility;
    }
    return weakened_visibility(visibility, strength);
}

@else
fn light_share(visibility: f32, strength: f32) -> f32 {
    return visibility;
}

/// Returns the visibility of a punctual light whose first map is `local_maps[first - 1]`; 0 means
/// none. `from_light` points from the light to the receiver. A point light has six maps, a spot
/// light one.
@if(SHADOWS || SHADOW_SOFT || SHADOW_MOMENTS)
fn light_visibility(first: u32, is_point: bool, from_light: vec3<f32>, receiver: Receiver) -> f32 {
    if !LAMP_SHADOWS || first == 0u || !receives_shadows() {
        return 1.0;
    }
    let face = select(0u, cube_face_of(from_light), is_point);
    return map_visibility(local_maps[first - 1u + face], receiver);
}

@else
fn light_visibility(first: u32, is_point: bool, from_light: vec3<f32>, receiver: Receiver) -> f32 {
    return 1.0;
}

/// Returns a debug color for the cascade if SHOW_CASCADES is on; otherwise white.
@if(SHADOWS || SHADOW_SOFT || SHADOW_MOMENTS)
fn cascade_tint(world: vec3<f32>) -> vec3<f32> {
    if !SHOW_CASCADES {
        return vec3<f32>(1.0);
    }
    let cascade = cascade_at(ahead_m(world), shadow.far_ends);
    let tints = array<vec3<f32>, 5>(
        vec3<f32>(1.0, 0.25, 0.25), vec3<f32>(0.25, 1.0, 0.25), vec3<f32>(0.25, 0.25, 1.0),
        vec3<f32>(1.0, 1.0, 0.25), vec3<f32>(1.0),
    );
    return tints[min(select(4u, cascade, cascade < CASCADES), 4u)];
}

@else
fn cascade_tint(world: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(1.0);
}

/// Returns the visibility in one map; 1 outside the map.
@if(SHADOWS || SHADOW_SOFT || SHADOW_MOMENTS)
fn map_visibility(map: ShadowMapUniforms, receiver: Receiver) -> f32 {
    let w = dot(vec4<f32>(receiver.world, 1.0), transpose(map.clip_from_world)[3]);
    let offset = normal_offset(receiver.normal, map.right, map.up, texel_scale(map, w));
    let world = vec4<f32>(receiver.world + offset, 1.0);
    let clip = map.clip_from_world * world;
    let at = shadow_uvz_from_clip(clip);
    if clip.w <= 0.0 || any(at < vec3<f32>(0.0)) || any(at > vec3<f32>(1.0)) {
        return 1.0;
    }
        @if(SHADOW_MOMENTS)
    return moments_visibility(map, receiver.normal, world, clip, at);
    @elif(SHADOW_SOFT)
    return soft_visibility(map, receiver, clip, at);
    @else
    return tent_visibility(map, at);
}
