// Copy: draws one texture into another with a full-screen triangle.
//
// `fs_copy` copies texels unchanged between targets of the same size and different formats. For
// equal formats, a copy command is faster. `fs_blit` filters, for targets of a different size.

import package::lib::fullscreen::{fullscreen_position, uv_from_clip};

@group(0) @binding(0) var source: texture_2d<f32>;
/// Linear filter, clamp to edge; only `fs_blit` uses it.
@group(0) @binding(1) var source_sampler: sampler;

struct CopyVertex {
    @builtin(position) position: vec4<f32>,
    @location(0) uv: vec2<f32>,
}

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> CopyVertex {
    let position = fullscreen_position(vertex, 0.0);
    return CopyVertex(position, uv_from_clip(position.xy));
}

/// Copies the texel at the same pixel.
@fragment
fn fs_copy(vertex: CopyVertex) -> @location(0) vec4<f32> {
    return textureLoad(source, vec2<i32>(vertex.position.xy), 0);
}

/// Stretches the source over the target with bilinear filtering.
@fragment
fn fs_blit(vertex: CopyVertex) -> @location(0) vec4<f32> {
    return textureSampleLevel(source, source_sampler, vertex.uv, 0.0);
}
