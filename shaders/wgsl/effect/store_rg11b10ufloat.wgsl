// Effect: rounds a color as if it were stored as Rg11b10Ufloat and read back; see
// effect/store_rgba16float.wgsl.

import package::lib::quantize::quantize_rg11b10ufloat;

/// True if the device rounds toward zero when it stores such floats.
override RG11B10UFLOAT_TOWARD_ZERO: bool = false;

/// Returns the color as read back; alpha is one, because the format has none.
fn store_rg11b10ufloat(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    return quantize_rg11b10ufloat(color.rgb, RG11B10UFLOAT_TOWARD_ZERO);
}
