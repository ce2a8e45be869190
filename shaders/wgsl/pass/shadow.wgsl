// Shadow map: depth of the scene as a light sees it.
//
// Depth only, reversed-Z (nearest 1, cleared to 0, compare Greater). Opaque geometry reads
// nothing but positions; alpha-masked geometry also reads the material, to leave the holes
// open. Group 0 holds the light's own view and not the frame's, so that cascades and spot
// lights are more draws and no more shaders. Slope-scaled bias belongs to the pipeline; the
// offset along the normal is applied by the receiver (lib/shadow.wgsl).

import package::interface::object::{objects, world_position};
import package::interface::material::{material, base_color};

/// The view a shadow map is drawn with. Mirrored by `layout::ShadowViewUniforms`.
struct ShadowViewUniforms {
    /// World to the light's clip space, reversed-Z.
    clip_from_world: mat4x4<f32>,
}

@group(0) @binding(0) var<uniform> shadow_view: ShadowViewUniforms;

struct MaskVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec4<f32>,
    @location(1) alpha: f32,
}

/// Opaque geometry; no fragment stage.
@vertex
fn vs_opaque(
    @builtin(instance_index) instance: u32,
    @location(0) position: vec3<f32>,
) -> @builtin(position) vec4<f32> {
    return shadow_view.clip_from_world * vec4<f32>(world_position(position, instance), 1.0);
}

/// Alpha-masked geometry.
@vertex
fn vs_mask(
    @builtin(instance_index) instance: u32,
    @location(0) position: vec3<f32>,
    @location(3) uv0: vec2<f32>,
    @location(4) uv1: vec2<f32>,
    @location(5) color: vec4<f32>,
) -> MaskVertex {
    let world = world_position(position, instance);
    return MaskVertex(
        shadow_view.clip_from_world * vec4<f32>(world, 1.0),
        vec4<f32>(uv0, uv1),
        color.a,
    );
}

/// Writes no color: it only removes what the mask removes.
@fragment
fn fs_mask(vertex: MaskVertex) {
    let alpha = base_color(vertex.uv, vec4<f32>(1.0, 1.0, 1.0, vertex.alpha)).a;
    if alpha < material.alpha_cutoff {
        discard;
    }
}
