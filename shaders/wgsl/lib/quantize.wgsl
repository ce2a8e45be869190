// Quantization: rounding to the small floating-point formats of textures.
//
// Drivers round differently when they store: most to nearest with ties to even, some (Mesa's
// software rasterizers) toward zero. Both are offered; which one a device does is measured.
// Done by scaling with exact powers of two, since rounding through a conversion may be folded
// away by a compiler that knows better.

/// Largest finite numbers of ten and eleven bits without a sign (both 2^15 · (2 - 2^-bits)).
const UFLOAT10_MAX: f32 = 64512.0;
const UFLOAT11_MAX: f32 = 65024.0;
/// Largest finite half float.
const FLOAT16_MAX: f32 = 65504.0;

/// x rounded to `bits` explicit mantissa bits, with five bits of exponent as in a half float:
/// below 2^-14 the spacing stays what it is there (subnormal numbers). For |x| < 65536.
fn quantize_mantissa(x: f32, bits: u32, toward_zero: bool) -> f32 {
    // Biased exponent of x in f32, not less than that of 2^-14.
    let exponent = max((bitcast<u32>(x) >> 23u) & 0xffu, 113u);
    // Spacing of the results and its reciprocal: 2^(exponent - 127 - bits) and the other way.
    let spacing = bitcast<f32>((exponent - bits) << 23u);
    let per_spacing = bitcast<f32>((254u + bits - exponent) << 23u);
    let scaled = x * per_spacing;
    return select(round(scaled), trunc(scaled), toward_zero) * spacing;
}

/// Quantizes a color as an Rgba16Float texture does; values out of range are clamped.
fn quantize_rgba16float(color: vec4<f32>, toward_zero: bool) -> vec4<f32> {
    let c = clamp(color, vec4<f32>(-FLOAT16_MAX), vec4<f32>(FLOAT16_MAX));
    return vec4<f32>(
        quantize_mantissa(c.x, 10u, toward_zero),
        quantize_mantissa(c.y, 10u, toward_zero),
        quantize_mantissa(c.z, 10u, toward_zero),
        quantize_mantissa(c.w, 10u, toward_zero),
    );
}

/// Quantizes a color as an Rg11b10Ufloat texture does: six, six and five mantissa bits, no negative
/// values, and an alpha of one.
fn quantize_rg11b10ufloat(color: vec3<f32>, toward_zero: bool) -> vec4<f32> {
    let c = clamp(color, vec3<f32>(0.0), vec3<f32>(UFLOAT11_MAX, UFLOAT11_MAX, UFLOAT10_MAX));
    return vec4<f32>(
        quantize_mantissa(c.x, 6u, toward_zero),
        quantize_mantissa(c.y, 6u, toward_zero),
        quantize_mantissa(c.z, 5u, toward_zero),
        1.0,
    );
}
