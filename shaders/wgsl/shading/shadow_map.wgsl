// Lookup in a shadow map: functions that all filters share.

import package::interface::frame::frame;
import package::interface::shadow::{shadow, ShadowMapUniforms};

/// Point that receives shadows: its world position, the unit geometric normal, and the pixel.
struct Receiver {
    world: vec3<f32>,
    normal: vec3<f32>,
    pixel: vec2<f32>,
    /// Screen-space derivatives of depth.
    slope: vec2<f32>,
}

/// Returns the distance ahead of the eye in m.
fn ahead_m(world: vec3<f32>) -> f32 {
    return -dot(frame.world_from_view[2].xyz, world);
}

/// Returns the texel size along the map's axes, relative to w = 1.
fn texel_scale(map: ShadowMapUniforms, w: f32) -> vec2<f32> {
    return vec2<f32>(w, w * select(1.0, w, map.warped != 0u));
}

/// Returns the world size of a texel along the map's axes at this w, in m.
fn texel_m(map: ShadowMapUniforms, w: f32) -> vec2<f32> {
    return vec2<f32>(map.texel_right_m, map.texel_up_m) * texel_scale(map, w);
}

/// Converts map coordinates to layer coordinates, clamped to the map's edge: half a texel of
/// `level` inside. No filter reads outside the map. For maps that fill a layer, samplers clamp.
fn layer_uv(map: ShadowMapUniforms, uv: vec2<f32>, level: f32) -> vec2<f32> {
    if map.uv_scale == 1.0 {
        return uv;
    }
    let half = min(0.5 * exp2(level) / shadow.texels, 0.5 * map.uv_scale);
    return clamp(
        map.uv_corner + uv * map.uv_scale,
        map.uv_corner + half,
        map.uv_corner + map.uv_scale - half,
    );
}

/// Returns the change of texture coordinates along a world-space direction.
fn uvz_along(map: ShadowMapUniforms, clip: vec4<f32>, direction: vec3<f32>) -> vec3<f32> {
    let change = map.clip_from_world * vec4<f32>(direction, 0.0);
    let ndc = (change.xyz - clip.xyz / clip.w * change.w) / clip.w;
    return vec3<f32>(ndc.x * 0.5, ndc.y * -0.5, ndc.z);
}
