// Shadow map: depth of the scene as a light sees it, or moments of it.
//
// Reversed-Z (nearest 1, cleared to 0, compare Greater). Opaque geometry reads nothing but
// positions; alpha-masked geometry also reads the material, to leave the holes open. Group 0
// holds the light's own view and not the frame's, so that cascades and local lights are more
// draws and no more shaders. Slope-scaled bias belongs to the pipeline; the offset along the
// normal is applied by the receiver (lib/shadow.wgsl). Moments (lib/shadow_moments.wgsl) are
// of depth along the light, which is linear whatever the view's perspective.

import package::interface::object::{Instance, world_position};
import package::interface::material::{material, base_color};
import package::lib::fullscreen::fullscreen_position;
import package::lib::shadow_moments::depth_moments;

/// The view a shadow map is drawn with. Mirrored by `layout::ShadowViewUniforms`.
struct ShadowViewUniforms {
    /// World to the light's clip space, reversed-Z.
    clip_from_world: mat4x4<f32>,
    /// World to depth away from the light: 0 at the near end of the map, 1 at the far end.
    linear_depth: vec4<f32>,
    /// Exponent of the warp of moments.
    exponent: f32,
}

@group(0) @binding(0) var<uniform> shadow_view: ShadowViewUniforms;

struct OpaqueVertex {
    @builtin(position) position: vec4<f32>,
    /// Linear depth. At the middle of a texel that a triangle covers in part it would be that of a
    /// place beside the triangle, which the warp makes of any size: it is taken where it covers.
    @location(2) @interpolate(perspective, centroid) depth: f32,
}

struct MaskVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec4<f32>,
    @location(1) alpha: f32,
    /// Linear depth, taken where the triangle covers the texel.
    @location(2) @interpolate(perspective, centroid) depth: f32,
}

/// The far end, over a map that is drawn again.
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

/// Removes what the mask removes.
fn cut(uv: vec4<f32>, alpha: f32) {
    if base_color(uv, vec4<f32>(1.0, 1.0, 1.0, alpha)).a < material.alpha_cutoff {
        discard;
    }
}

/// Writes no color.
@fragment
fn fs_mask(vertex: MaskVertex) {
    cut(vertex.uv, vertex.alpha);
}

/// Moments of the fragment's depth.
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
