// Depth prepass: the depth of the visible surfaces, before anything is shaded.
//
// The color pass then shades each pixel once, with depth compare Equal. That asks for the
// same depth to the last bit, so both passes take the position from
// interface/object.wgsl and mark it @invariant, and masked geometry decides on the same alpha.
// Reversed-Z, compare Greater, cleared to 0.

import package::interface::object::{Instance, world_position, clip_position};
import package::interface::material::{material, base_color};

struct OpaqueVertex {
    @invariant @builtin(position) position: vec4<f32>,
}

struct MaskVertex {
    @invariant @builtin(position) position: vec4<f32>,
    @location(0) uv: vec4<f32>,
    @location(1) alpha: f32,
}

/// Opaque geometry; no fragment stage.
@vertex
fn vs_opaque(
    instance: Instance,
    @location(0) position: vec3<f32>,
) -> OpaqueVertex {
    return OpaqueVertex(clip_position(world_position(position, instance)));
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
    return MaskVertex(
        clip_position(world_position(position, instance)),
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
