// Scene: pyramid of the opaque image, which refractive surfaces sample.
//
// `fs_copy` and `fs_copy_samples` write level 0: the radiance, and the distance in alpha.
// `fs_level` computes each level from the previous one.

import package::interface::frame::frame;
import package::interface::scene::distance_ahead;
import package::lib::fullscreen::{fullscreen_position, uv_from_clip};
import package::lib::numerics::saturate_half3;

/// Pre-exposed radiance of opaque surfaces and the sky.
@group(0) @binding(1) var hdr: texture_2d<f32>;
/// Reversed depth of the opaque surfaces; 0 for the sky. Bound as unfilterable floats, because
/// OpenGL cannot load texels of depth textures.
@group(0) @binding(2) var scene_depth: texture_2d<f32>;
@group(0) @binding(3) var scene_depth_samples: texture_multisampled_2d<f32>;
/// Previous level.
@group(0) @binding(4) var source: texture_2d<f32>;
/// Linear filter, clamp to edge.
@group(0) @binding(5) var source_sampler: sampler;

/// Largest finite half float.
const FARTHEST_M: f32 = 65504.0;

struct SceneVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> SceneVertex {
    let position = fullscreen_position(vertex, 0.0);
    return SceneVertex(position, uv_from_clip(position.xy));
}

/// Returns radiance and distance. Removes NaN and infinity, because each level spreads a bad pixel
/// over four times the area.
fn with_distance(vertex: SceneVertex, depth: f32) -> vec4<f32> {
    let color = saturate_half3(textureLoad(hdr, vec2<i32>(vertex.position.xy), 0).rgb);
    let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.y * 2.0);
    let h = frame.world_from_clip * vec4<f32>(ndc, depth, 1.0);
    var distance_m = FARTHEST_M;
    // With an infinite far plane, depth 0 is at infinity and w is 0.
    if h.w > 1e-6 {
        distance_m = clamp(distance_ahead(h.xyz / h.w), 0.0, FARTHEST_M);
    }
    return vec4<f32>(color, distance_m);
}

/// Writes level 0 from single-sampled textures.
@fragment
fn fs_copy(vertex: SceneVertex) -> @location(0) vec4<f32> {
    let depth = textureLoad(scene_depth, vec2<i32>(vertex.position.xy), 0).r;
    return with_distance(vertex, depth);
}

/// Writes level 0 from multisampled textures, with the distance of the first sample.
@fragment
fn fs_copy_samples(vertex: SceneVertex) -> @location(0) vec4<f32> {
    let depth = textureLoad(scene_depth_samples, vec2<i32>(vertex.position.xy), 0).r;
    return with_distance(vertex, depth);
}

/// Computes the next level with the kernel (1 3 3 1)/8 in both directions. A linear filter gives
/// both halves the weights 1 : 3 at three quarters of a texel from the center.
@fragment
fn fs_level(vertex: SceneVertex) -> @location(0) vec4<f32> {
    let d = 0.75 / vec2<f32>(textureDimensions(source, 0));
    let sum = textureSampleLevel(source, source_sampler, vertex.uv + vec2<f32>(-d.x, -d.y), 0.0)
        + textureSampleLevel(source, source_sampler, vertex.uv + vec2<f32>(d.x, -d.y), 0.0)
        + textureSampleLevel(source, source_sampler, vertex.uv + vec2<f32>(-d.x, d.y), 0.0)
        + textureSampleLevel(source, source_sampler, vertex.uv + vec2<f32>(d.x, d.y), 0.0);
    return sum * 0.25;
}
