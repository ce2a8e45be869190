// Fog: radiance fades toward that of the fog with the distance to what is there.

import package::interface::frame::frame;
import package::lib::fullscreen::{fullscreen_position, uv_from_clip};

struct Fog {
    /// Radiance of thick fog as a share of white on the display, linear Rec.709.
    color: vec3<f32>,
    /// Extinction in 1/m: after 1/density meters a share of 1/e is left.
    density: f32,
}

@group(0) @binding(1) var hdr: texture_2d<f32>;
/// One sample per texel, reversed: 0 is the far plane.
@group(0) @binding(2) var depth: texture_depth_2d;
@group(0) @binding(3) var<uniform> fog: Fog;

struct FogVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> FogVertex {
    let position = fullscreen_position(vertex, 0.0);
    return FogVertex(position, uv_from_clip(position.xy));
}

@fragment
fn fs_main(vertex: FogVertex) -> @location(0) vec4<f32> {
    let at = vec2<i32>(vertex.position.xy);
    let shaded = textureLoad(hdr, at, 0);
    let reversed_depth = textureLoad(depth, at, 0);
    // Where nothing is, the sky is: it has its own haze.
    if reversed_depth == 0.0 {
        return shaded;
    }
    let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.y * 2.0);
    let world = frame.world_from_clip * vec4<f32>(ndc, reversed_depth, 1.0);
    // Positions are relative to the eye.
    let distance_m = length(world.xyz / world.w);
    return vec4<f32>(mix(fog.color, shaded.rgb, exp(-fog.density * distance_m)), shaded.a);
}
