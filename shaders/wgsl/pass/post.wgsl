// Post: from HDR to the display, everything point-wise in one pass.
//
// Exposure compensation, tone curve, sRGB encoding, dithering. Each pixel reads only itself
// (textureLoad, no sampler), so the pass can be kept in the tile, or inlined into the pass
// that makes its input.

import package::lib::dither::dither_offset;
import package::lib::fullscreen::fullscreen_position;
import package::lib::luminance::luminance;
import package::lib::srgb::{linear_from_srgb, srgb_from_linear};
import package::lib::tone_map::tone_map;

/// Settings of the pass. Mirrored by `layout::PostUniforms`.
struct PostUniforms {
    /// Factor on the pre-exposed input: 2^(exposure compensation in EV).
    exposure_scale: f32,
    /// Amplitude of the dither: 1 for the full half code either way, 0 for none.
    dither: f32,
    /// Codes of the target less one: 255 for 8 bits.
    dither_levels: f32,
    /// Moves the dither pattern from frame to frame.
    frame_index: u32,
}

/// The curve, a TONE_MAP_* of lib/tone_map.wgsl.
override TONE_MAP: u32 = 1u;
/// True writes sRGB encoded values to a Unorm target, as FXAA wants them; false writes linear
/// ones to an sRGB target, which encodes them itself.
override OUTPUT_ENCODED: bool = false;
/// True writes the luma of the encoded color into alpha for FXAA; false keeps the input's
/// alpha.
override LUMA_IN_ALPHA: bool = false;

@group(0) @binding(0) var<uniform> post: PostUniforms;
/// Pre-exposed linear Rec.709, single-sampled, of the size of the target.
@group(0) @binding(1) var hdr: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

@fragment
fn fs_main(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = textureLoad(hdr, vec2<i32>(position.xy), 0);
    let display = tone_map(texel.rgb * post.exposure_scale, TONE_MAP);
    let noise = dither_offset(position.xy, post.frame_index, post.dither_levels) * post.dither;
    let encoded = saturate(srgb_from_linear(display) + noise);
    let color = select(linear_from_srgb(encoded), encoded, OUTPUT_ENCODED);
    return vec4<f32>(color, select(texel.a, luminance(encoded), LUMA_IN_ALPHA));
}
