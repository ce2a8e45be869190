// Shadow map: depth of the scene from a light, or its moments.
//
// Reversed-Z (nearest 1, cleared to 0, compare Greater). Opaque geometry reads only positions;
// alpha-masked geometry also reads the material for its alpha test. Group 0 holds the light's view
// instead of the frame's, so that cascades and punctual lights share the shaders. The pipeline sets
// the slope-scaled bias; the receiver applies the normal offset (lib/shadow.wgsl). Moments
// (lib/shadow_moments.wgsl) use linear depth along the light, for any projection.

import package::interface::object::{Instance, world_position};
import package::interface::material::{material, base_color};
import package::lib::fullscreen::fullscreen_position;
import package::lib::shadow_moments::depth_moments;

/// View that draws a shadow map. Mirrored by `layout::ShadowViewUniforms`.
struct ShadowViewUniforms {
    /// World to light clip space, reversed-Z.
    clip_from_world: mat4x4<f32>,
    /// World to linear depth: 0 at the near end of the map, 1 at the far end.
    linear_depth: vec4<f32>,
    /// Exponent of the depth warp for moments.
    exponent: f32,
}

@group(0) @binding(0) var<uniform> shadow_view: ShadowViewUniforms;

struct OpaqueVertex {
    @builtin(position) position: vec4<f32>,
    /// Linear depth, sampled at the centroid. At the center of a partly covered texel it would be
    /// extrapolated beyond the triangle, and the warp would amplify the error.
    @location(2) @interpolate(perspective, centroid) depth: f32,
}

struct MaskVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec4<f32>,
    @location(1) alpha: f32,
    /// Linear depth, sampled at the centroid.
    @location(2) @interpolate(perspective, centroid) depth: f32,
}

/// Clears a map to the far end before it is drawn again.
@vertex
fn vs_far(@builtin(vertex_index) index: u32) -> OpaqueVertex {
    return OpaqueVertex(fullscreen_position(index, 0.0), 1.0);
}

/// Opaque geometry.
@vertex
fn vs_opaque(
    instance: Instance,
    @location(0) position: vec3<f32>,
) -> OpaqueVertex {
    let world = vec4<f32>(world_position(position, instance), 1.0);
    return OpaqueVertex(shadow_view.clip_from_world * world, dot(shadow_view.linear_depth, world));
}

/// Alpha-masked geometry.
@vertex
fn vs_mask(
    instance: Instance,
    @location(0) position: vec3<f32>,
    @location(3) uv0: vec2<f32>,
    @location(4) uv1: vec2<f32>,
    @location(5) color: vec4<f32>,
) -> MaskVertex {
    let world = vec4<f32>(world_position(position, instance), 1.0);
    return MaskVertex(
        shadow_view.clip_from_world * world,
        vec4<f32>(uv0, uv1),
        color.a,
        dot(shadow_view.linear_depth, world),
    );
}

/// Discards masked fragments.
fn cut(uv: vec4<f32>, alpha: f32) {
    if base_color(uv, vec4<f32>(1.0, 1.0, 1.0, alpha)).a < material.alpha_cutoff {
        discard;
    }
}

/// Writes no color and discards masked fragments.
@fragment
fn fs_mask(vertex: MaskVertex) {
    cut(vertex.uv, vertex.alpha);
}

/// Returns the moments of the fragment's depth.
fn moments(depth: f32) -> vec4<f32> {
    let found = depth_moments(depth, dpdx(depth), dpdy(depth), shadow_view.exponent);
    return vec4<f32>(found, 0.0, 0.0);
}

@fragment
fn fs_opaque_moments(vertex: OpaqueVertex) -> @location(0) vec4<f32> {
    return moments(vertex.depth);
}

@fragment
fn fs_mask_moments(vertex: MaskVertex) -> @location(0) vec4<f32> {
    let found = moments(vertex.depth);
    cut(vertex.uv, vertex.alpha);
    return found;
}
