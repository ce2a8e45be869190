// A map of a light, looked up by place: what all ways to read it share.

import package::interface::frame::frame;
import package::interface::shadow::{shadow, ShadowMapUniforms};

/// A point that a shadow falls on: where in the world, the triangle's unit normal, and the pixel.
struct Receiver {
    world: vec3<f32>,
    normal: vec3<f32>,
    pixel: vec2<f32>,
    /// Change of depth from pixel to pixel.
    slope: vec2<f32>,
}

/// Distance ahead of the eye in m.
fn ahead_m(world: vec3<f32>) -> f32 {
    return -dot(frame.world_from_view[2].xyz, world);
}

/// By how much a texel of the map is larger along its axes than where w = 1.
fn texel_scale(map: ShadowMapUniforms, w: f32) -> vec2<f32> {
    return vec2<f32>(w, w * select(1.0, w, map.warped != 0u));
}

/// World size in m of a texel of the map along its axes, at this w.
fn texel_m(map: ShadowMapUniforms, w: f32) -> vec2<f32> {
    return vec2<f32>(map.texel_right_m, map.texel_up_m) * texel_scale(map, w);
}

/// Coordinates in the layer of coordinates in the map: taps beyond its edge take the edge, which of
/// `level` lies half a texel of that level inside. So no filter reaches what lies beside the map.
/// Of a map that takes the whole layer samplers see to that.
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

/// How texture coordinates change along a direction in the world.
fn uvz_along(map: ShadowMapUniforms, clip: vec4<f32>, direction: vec3<f32>) -> vec3<f32> {
    let change = map.clip_from_world * vec4<f32>(direction, 0.0);
    let ndc = (change.xyz - clip.xyz / clip.w * change.w) / clip.w;
    return vec3<f32>(ndc.x * 0.5, ndc.y * -0.5, ndc.z);
}
