// Depth prepass: the depth of the visible surfaces, before anything is shaded.
//
// The color pass then shades each pixel once, with depth compare Equal. This requires bit-identical
// depth, so both passes compute the position in interface/object.wgsl and mark it @invariant.
// Masked geometry uses the same alpha test. Reversed-Z, compare Greater, cleared to 0.

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
    return OpaqueVertex(clip_position(world_position(position, instance), instance));
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
        clip_position(world_position(position, instance), instance),
        vec4<f32>(uv0, uv1),
        color.a,
    );
}

/// Writes no color and discards masked fragments.
@fragment
fn fs_mask(vertex: MaskVertex) {
    let alpha = base_color(vertex.uv, vec4<f32>(1.0, 1.0, 1.0, vertex.alpha)).a;
    if alpha < material.alpha_cutoff {
        discard;
    }
}

/// True for the first layer, which has no previous layer.
override FIRST_LAYER: bool = false;

/// Reversed depth of opaque surfaces. Bound as unfilterable floats, because OpenGL cannot load
/// texels of depth textures.
@group(0) @binding(49) var opaque_depth: texture_2d<f32>;
@group(0) @binding(50) var opaque_depth_samples: texture_multisampled_2d<f32>;
/// Depth of the previous layer.
@group(0) @binding(51) var nearer_layer: texture_2d<f32>;
@group(0) @binding(52) var nearer_layer_samples: texture_multisampled_2d<f32>;

/// Discards fragments of earlier layers, hidden fragments, and fully transparent fragments.
fn peel(vertex: MaskVertex, hidden: f32, nearer: f32) {
    let alpha = base_color(vertex.uv, vec4<f32>(1.0, 1.0, 1.0, vertex.alpha)).a;
    let peeled = !FIRST_LAYER && vertex.position.z >= nearer;
    if alpha <= 0.0 || vertex.position.z < hidden || peeled {
        discard;
    }
}

/// Draws a layer of blended surfaces.
@fragment
fn fs_peel(vertex: MaskVertex) {
    let texel = vec2<i32>(vertex.position.xy);
    let hidden = textureLoad(opaque_depth, texel, 0).r;
    peel(vertex, hidden, textureLoad(nearer_layer, texel, 0).r);
}

/// Draws a layer of blended surfaces, per sample.
@fragment
fn fs_peel_samples(vertex: MaskVertex, @builtin(sample_index) index: u32) {
    let texel = vec2<i32>(vertex.position.xy);
    let hidden = textureLoad(opaque_depth_samples, texel, index).r;
    peel(vertex, hidden, textureLoad(nearer_layer_samples, texel, index).r);
}
