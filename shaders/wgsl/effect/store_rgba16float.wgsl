// Effect: what is left of a color that was stored as Rgba16Float and read back.
//
// An epilogue takes the color as it was shaded, in f32; with this in front it sees the same
// bits as a pass of its own that reads the color from a texture.

import package::lib::quantize::quantize_rgba16float;

/// True where the device rounds toward zero when it stores half floats.
override RGBA16FLOAT_TOWARD_ZERO: bool = false;

/// The color as read back.
fn store_rgba16float(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    return quantize_rgba16float(color, RGBA16FLOAT_TOWARD_ZERO);
}
