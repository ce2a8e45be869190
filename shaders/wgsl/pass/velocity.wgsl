// Velocity: where in the picture of the frame before the surfaces of what moves were.
//
// Drawn over the depth of the visible surfaces where it is equal, as the color pass is, and with
// the same position to the bit. Both clip positions come from matrices that were joined in f64,
// without jitter. The last number counts samples: an average over some that moved and some that did
// not, over it, is the mean of those that did.

import package::interface::material::{material, base_color};
import package::interface::object::{Instance, world_position, clip_position};

/// Clip space of this frame and of the one before, from model space. Mirrored by
/// `layout::MotionUniforms`.
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
        clip_position(world_position(position, instance)),
        (motions[instance.number].clip_from_model * vec4<f32>(position, 1.0)).xyw,
        (motions[instance.number].earlier_clip_from_model * vec4<f32>(earlier, 1.0)).xyw,
        vec4<f32>(uv0, uv1),
        color.a,
    );
}

/// From texture coordinates here to those before, and 1. Where the place was behind the eye it was
/// nowhere in the picture.
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

/// What the mask removes has no depth to be equal to, but may lie on a depth of its own kind.
@fragment
fn fs_mask(vertex: VelocityVertex) -> @location(1) vec4<f32> {
    let alpha = base_color(vertex.uv, vec4<f32>(1.0, 1.0, 1.0, vertex.alpha)).a;
    if alpha < material.alpha_cutoff {
        discard;
    }
    return velocity(vertex);
}
