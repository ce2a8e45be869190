// Scene: the picture of everything opaque as a pyramid, for what transmissive surfaces show.
//
// `fs_copy` and `fs_copy_samples` make level 0: the radiance, and in alpha how far away it is.
// `fs_level` makes each level of the one above.

import package::interface::frame::frame;
import package::interface::scene::distance_ahead;
import package::lib::fullscreen::{fullscreen_position, uv_from_clip};
import package::lib::numerics::saturate_half3;

/// Pre-exposed radiance of opaque surfaces and the sky.
@group(0) @binding(1) var hdr: texture_2d<f32>;
/// Their depth, reversed-Z; 0 is the sky. Loaded as unfilterable floats: OpenGL loads no texels of
/// depth textures as such.
@group(0) @binding(2) var scene_depth: texture_2d<f32>;
@group(0) @binding(3) var scene_depth_samples: texture_multisampled_2d<f32>;
/// The level above.
@group(0) @binding(4) var source: texture_2d<f32>;
/// Linear filter, clamp to edge.
@group(0) @binding(5) var source_sampler: sampler;

/// The largest half float.
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

/// The radiance with its distance. What is no radiance is none here: a level has it in a fourth
/// of the texels of the one above, so one bad pixel would blacken all that shows the last level.
fn with_distance(vertex: SceneVertex, depth: f32) -> vec4<f32> {
    let color = saturate_half3(textureLoad(hdr, vec2<i32>(vertex.position.xy), 0).rgb);
    let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.y * 2.0);
    let h = frame.world_from_clip * vec4<f32>(ndc, depth, 1.0);
    var distance_m = FARTHEST_M;
    // With an infinite far plane depth 0 is infinitely far away: w is 0.
    if h.w > 1e-6 {
        distance_m = clamp(distance_ahead(h.xyz / h.w), 0.0, FARTHEST_M);
    }
    return vec4<f32>(color, distance_m);
}

/// Level 0 of a picture with one sample per texel.
@fragment
fn fs_copy(vertex: SceneVertex) -> @location(0) vec4<f32> {
    let depth = textureLoad(scene_depth, vec2<i32>(vertex.position.xy), 0).r;
    return with_distance(vertex, depth);
}

/// Level 0 of a picture with several: the distance is that of the first.
@fragment
fn fs_copy_samples(vertex: SceneVertex) -> @location(0) vec4<f32> {
    let depth = textureLoad(scene_depth_samples, vec2<i32>(vertex.position.xy), 0).r;
    return with_distance(vertex, depth);
}

/// The next level: the kernel (1 3 3 1)/8 both ways, whose two halves a linear filter weights as
/// 1 : 3 at three quarters of a texel from the middle.
@fragment
fn fs_level(vertex: SceneVertex) -> @location(0) vec4<f32> {
    let d = 0.75 / vec2<f32>(textureDimensions(source, 0));
    let sum = textureSampleLevel(source, source_sampler, vertex.uv + vec2<f32>(-d.x, -d.y), 0.0)
        + textureSampleLevel(source, source_sampler, vertex.uv + vec2<f32>(d.x, -d.y), 0.0)
        + textureSampleLevel(source, source_sampler, vertex.uv + vec2<f32>(-d.x, d.y), 0.0)
        + textureSampleLevel(source, source_sampler, vertex.uv + vec2<f32>(d.x, d.y), 0.0);
    return sum * 0.25;
}
