// Radiance in four channels of eight bits, with a factor in alpha: RGBM.
//
// Filament's form: color = (16 · rgb · a)², so numbers from 0 to 256 are held. The square spends
// codes on the dark. A filter interpolates the codes and not the colors, so texels whose factors
// differ give wrong colors in between: the price of the format, beside its steps.

/// Number in [0, 256] of RGBM codes in [0, 1].
fn linear_from_rgbm(codes: vec4<f32>) -> vec3<f32> {
    let root = codes.rgb * (16.0 * codes.a);
    return root * root;
}
