// Post: a full-screen pass of point-wise effects, from HDR to the display.
//
// The effects are chosen at resolution (see interface/epilogue.wgsl): all of them in one pass, or
// one in each of several passes. Each pixel reads only itself (textureLoad, no sampler). The pass
// can therefore stay in tile memory, or be inlined into the pass that produces its input.

import package::interface::epilogue::epilogue;
import package::lib::fullscreen::fullscreen_position;

/// Pre-exposed linear Rec.709, single-sampled, with the size of the target.
@group(0) @binding(0) var hdr: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

@fragment
fn fs_main(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    return epilogue(textureLoad(hdr, vec2<i32>(position.xy), 0), position.xy);
}
