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

/// There is no layer before the one that is peeled.
override FIRST_LAYER: bool = false;

/// Depth of what is opaque, reversed. Loaded as unfilterable floats: OpenGL loads no texels of
/// depth textures as such.
@group(0) @binding(49) var opaque_depth: texture_2d<f32>;
@group(0) @binding(50) var opaque_depth_samples: texture_multisampled_2d<f32>;
/// Depth of the layer before.
@group(0) @binding(51) var nearer_layer: texture_2d<f32>;
@group(0) @binding(52) var nearer_layer_samples: texture_multisampled_2d<f32>;

/// Removes what belongs to a layer before, what is hidden, and what covers nothing.
fn peel(vertex: MaskVertex, hidden: f32, nearer: f32) {
    let alpha = base_color(vertex.uv, vec4<f32>(1.0, 1.0, 1.0, vertex.alpha)).a;
    let peeled = !FIRST_LAYER && vertex.position.z >= nearer;
    if alpha <= 0.0 || vertex.position.z < hidden || peeled {
        discard;
    }
}

/// A layer of blended surfaces.
@fragment
fn fs_peel(vertex: MaskVertex) {
    let texel = vec2<i32>(vertex.position.xy);
    let hidden = textureLoad(opaque_depth, texel, 0).r;
    peel(vertex, hidden, textureLoad(nearer_layer, texel, 0).r);
}

/// A layer of blended surfaces, sample by sample.
@fragment
fn fs_peel_samples(vertex: MaskVertex, @builtin(sample_index) index: u32) {
    let texel = vec2<i32>(vertex.position.xy);
    let hidden = textureLoad(opaque_depth_samples, texel, index).r;
    peel(vertex, hidden, textureLoad(nearer_layer_samples, texel, index).r);
}
