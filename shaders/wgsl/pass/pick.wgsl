// Picking: finds the visible object at one pixel, and its depth.
//
// The target has one texel, and the frame's clip space covers only the picked pixel. Positions and
// masks are those of the depth prepass.

import package::interface::object::{Instance, world_position, clip_position};
import package::interface::material::{material, base_color};

struct OpaqueVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) number: u32,
}

struct MaskVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) @interpolate(flat) number: u32,
    @location(1) uv: vec4<f32>,
    @location(2) alpha: f32,
}

@vertex
fn vs_opaque(
    instance: Instance,
    @location(0) position: vec3<f32>,
) -> OpaqueVertex {
    let world = world_position(position, instance);
    return OpaqueVertex(clip_position(world, instance), instance.number);
}

@vertex
fn vs_mask(
    instance: Instance,
    @location(0) position: vec3<f32>,
    @location(3) uv0: vec2<f32>,
    @location(4) uv1: vec2<f32>,
    @location(5) color: vec4<f32>,
) -> MaskVertex {
    return MaskVertex(
        clip_position(world_position(position, instance), instance),
        instance.number,
        vec4<f32>(uv0, uv1),
        color.a,
    );
}

/// Writes the object's number plus one (0 means nothing) and the bits of its reversed depth.
@fragment
fn fs_opaque(vertex: OpaqueVertex) -> @location(0) vec2<u32> {
    return vec2<u32>(vertex.number + 1u, bitcast<u32>(vertex.position.z));
}

@fragment
fn fs_mask(vertex: MaskVertex) -> @location(0) vec2<u32> {
    let alpha = base_color(vertex.uv, vec4<f32>(1.0, 1.0, 1.0, vertex.alpha)).a;
    if alpha < material.alpha_cutoff {
        discard;
    }
    return vec2<u32>(vertex.number + 1u, bitcast<u32>(vertex.position.z));
}
