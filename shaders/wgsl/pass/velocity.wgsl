// Velocity: motion vectors of moving surfaces.
//
// It is drawn with depth compare Equal, like the color pass, and computes bit-identical positions.
// Both clip positions come from matrices that were multiplied in f64, without jitter. The last
// component counts samples. The average over moving and static samples, divided by the count, is
// therefore the mean of the moving ones.

import package::interface::material::{material, base_color};
import package::interface::object::{Instance, world_position, clip_position};

/// Model-to-clip matrices of this and the previous frame. Mirrored by `layout::MotionUniforms`.
struct MotionUniforms {
    clip_from_model: mat4x4<f32>,
    earlier_clip_from_model: mat4x4<f32>,
}

@group(0) @binding(1) var<storage, read> motions: array<MotionUniforms>;

struct VelocityVertex {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) now: vec3<f32>,
    @location(1) before: vec3<f32>,
    @location(2) uv: vec4<f32>,
    @location(3) alpha: f32,
}

@vertex
fn vs_main(
    instance: Instance,
    @location(0) position: vec3<f32>,
    @location(3) uv0: vec2<f32>,
    @location(4) uv1: vec2<f32>,
    @location(5) color: vec4<f32>,
    @location(7) earlier: vec3<f32>,
) -> VelocityVertex {
    return VelocityVertex(
        clip_position(world_position(position, instance), instance),
        (motions[instance.number].clip_from_model * vec4<f32>(position, 1.0)).xyw,
        (motions[instance.number].earlier_clip_from_model * vec4<f32>(earlier, 1.0)).xyw,
        vec4<f32>(uv0, uv1),
        color.a,
    );
}

/// Returns the vector from texture coordinates here to those in the previous frame, and 1.
/// Positions behind the previous eye have no coordinates.
fn velocity(vertex: VelocityVertex) -> vec4<f32> {
    let now = vertex.now.xy / vertex.now.z;
    let before = vertex.before.xy / max(vertex.before.z, 1e-6);
    let way = clamp((before - now) * vec2<f32>(0.5, -0.5), vec2<f32>(-8.0), vec2<f32>(8.0));
    return vec4<f32>(select(vec2<f32>(8.0), way, vertex.before.z > 1e-6), 0.0, 1.0);
}

@fragment
fn fs_opaque(vertex: VelocityVertex) -> @location(1) vec4<f32> {
    return velocity(vertex);
}

/// Discards masked fragments, which could otherwise coincide with the depth of another surface.
@fragment
fn fs_mask(vertex: VelocityVertex) -> @location(1) vec4<f32> {
    let alpha = base_color(vertex.uv, vec4<f32>(1.0, 1.0, 1.0, vertex.alpha)).a;
    if alpha < material.alpha_cutoff {
        discard;
    }
    return velocity(vertex);
}
