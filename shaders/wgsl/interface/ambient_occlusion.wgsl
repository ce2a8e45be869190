// Ambient occlusion of the picture, as the color pass reads it: made by pass/occlusion.wgsl.
//
// Feature AMBIENT_OCCLUSION: there is such a picture.

/// Visibility in red, a texel a pixel; loaded.
@if(AMBIENT_OCCLUSION)
@group(0) @binding(21) var ambient_occlusion: texture_2d<f32>;

/// Visibility at a pixel, 0…1.
@if(AMBIENT_OCCLUSION)
fn screen_visibility(pixel: vec2<f32>) -> f32 {
    return textureLoad(ambient_occlusion, vec2<i32>(pixel), 0).r;
}
