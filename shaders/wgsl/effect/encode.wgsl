// Effect: encodes linear display light for the target, with dithering.

import package::lib::dither::dither_offset;
import package::lib::luminance::luminance;
import package::lib::srgb::{linear_from_srgb, srgb_from_linear};

/// Settings of `encode`. Mirrored by `layout::EncodingUniforms`.
struct EncodingUniforms {
    /// Amplitude of the dither: 1 for ± half a step, 0 for none.
    dither: f32,
    /// Largest integer value of the target: 255 for 8 bits.
    dither_levels: f32,
    /// Frame number, which shifts the dither pattern.
    @size(8) frame_index: u32,
}

/// True writes sRGB encoded values to a Unorm target, as FXAA needs; false writes linear values to
/// an sRGB target, which encodes them.
override OUTPUT_ENCODED: bool = false;
/// True writes the luma of the encoded color to alpha for FXAA; false keeps the input alpha.
override LUMA_IN_ALPHA: bool = false;

/// True if the input is already sRGB encoded, from a table or the mobile tone curve.
override INPUT_ENCODED: bool = false;

@group(0) @binding(0) var<uniform> encoding: EncodingUniforms;

/// Returns the value to write to the target.
fn encode(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    let noise = dither_offset(pixel, encoding.frame_index, encoding.dither_levels)
        * encoding.dither;
    var codes = color.rgb;
    if !INPUT_ENCODED {
        codes = srgb_from_linear(color.rgb);
    }
    let encoded = saturate(codes + noise);
    let written = select(linear_from_srgb(encoded), encoded, OUTPUT_ENCODED);
    return vec4<f32>(written, select(color.a, luminance(encoded), LUMA_IN_ALPHA));
}
