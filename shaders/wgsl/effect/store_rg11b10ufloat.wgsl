// Effect: what is left of a color that was stored as Rg11b10Ufloat and read back; see
// effect/store_rgba16float.wgsl.

import package::lib::quantize::quantize_rg11b10ufloat;

/// True where the device rounds toward zero when it stores such floats.
override RG11B10UFLOAT_TOWARD_ZERO: bool = false;

/// The color as read back; alpha, which the format has not, is one.
fn store_rg11b10ufloat(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    return quantize_rg11b10ufloat(color.rgb, RG11B10UFLOAT_TOWARD_ZERO);
}
