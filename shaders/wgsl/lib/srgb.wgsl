// The sRGB transfer functions (IEC 61966-2-1:1999).
//
// Exact piecewise forms: x^(1/2.2) is off by up to 8.5 8-bit steps and changes 79 % of 8-bit
// values. Prefer the encoding of a hardware sRGB target. The shader encodes only to dither, or to
// compute FXAA's luma from encoded values.

/// Linear light in [0, 1] from one encoded channel in [0, 1].
fn linear_from_srgb_channel(encoded: f32) -> f32 {
    let e = saturate(encoded);
    if e <= 0.04045 {
        return e / 12.92;
    }
    return pow((e + 0.055) / 1.055, 2.4);
}

/// Encoded channel in [0, 1] from linear light; clamps to [0, 1] first, since pow of a
/// negative is NaN (hard case 49).
fn srgb_from_linear_channel(linear: f32) -> f32 {
    let l = saturate(linear);
    if l <= 0.0031308 {
        return l * 12.92;
    }
    return 1.055 * pow(l, 1.0 / 2.4) - 0.055;
}

/// Linear Rec.709 color from an sRGB encoded one.
fn linear_from_srgb(encoded: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        linear_from_srgb_channel(encoded.x),
        linear_from_srgb_channel(encoded.y),
        linear_from_srgb_channel(encoded.z),
    );
}

/// sRGB encoded color from a linear Rec.709 one.
fn srgb_from_linear(linear: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(
        srgb_from_linear_channel(linear.x),
        srgb_from_linear_channel(linear.y),
        srgb_from_linear_channel(linear.z),
    );
}
