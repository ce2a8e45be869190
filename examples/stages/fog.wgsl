// Fog: blends radiance toward the fog color by the distance of the surface.

import package::interface::frame::frame;
import package::lib::fullscreen::{fullscreen_position, uv_from_clip};

struct Fog {
    /// Radiance of dense fog, linear Rec.709, relative to white on the display.
    color: vec3<f32>,
    /// Extinction coefficient in 1/m: transmittance is 1/e after 1/density meters.
    density: f32,
}

@group(0) @binding(1) var hdr: texture_2d<f32>;
/// Single-sampled reversed depth: 0 is the far plane.
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
    // Pixels of the sky have no depth and keep their radiance.
    if reversed_depth == 0.0 {
        return shaded;
    }
    let ndc = vec2<f32>(vertex.uv.x * 2.0 - 1.0, 1.0 - vertex.uv.y * 2.0);
    let world = frame.world_from_clip * vec4<f32>(ndc, reversed_depth, 1.0);
    // Positions are relative to the eye.
    let distance_m = length(world.xyz / world.w);
    return vec4<f32>(mix(fog.color, shaded.rgb, exp(-fog.density * distance_m)), shaded.a);
}
