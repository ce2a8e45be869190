// Effect: rounds a color as if it were stored as Rgba16Float and read back.
//
// An epilogue gets the shaded color in f32. With this effect first, it gets the same bits as a
// separate pass that reads the color from a texture.

import package::lib::quantize::quantize_rgba16float;

/// True if the device rounds toward zero when it stores half floats.
override RGBA16FLOAT_TOWARD_ZERO: bool = false;

/// Returns the color as read back.
fn store_rgba16float(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    return quantize_rgba16float(color, RGBA16FLOAT_TOWARD_ZERO);
}
