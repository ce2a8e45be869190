// Luminance and luma.

/// Returns the weighted sum of the channels with the luminance weights of Rec.709 (ITU-R BT.709-6,
/// item 3.2). For linear light it is the luminance Y; for sRGB encoded values it is the luma Y'
/// that FXAA compares.
fn luminance(color: vec3<f32>) -> f32 {
    return dot(color, vec3<f32>(0.2126, 0.7152, 0.0722));
}
