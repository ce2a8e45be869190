// Effect: darker corners.

import package::lib::vignette::vignette_transmittance;

/// Settings of `vignette`. Mirrored by `layout::VignetteUniforms`.
struct VignetteUniforms {
    /// Center of the image in pixels.
    centre_px: vec2<f32>,
    /// Reciprocal of the distance from the center to a corner, in 1/pixels.
    per_corner_px: f32,
    /// Growth of the falloff, see lib/vignette.wgsl.
    falloff: f32,
}

@group(0) @binding(0) var<uniform> vignetting: VignetteUniforms;

/// Applies the vignette to scene-referred linear light; alpha is unchanged.
fn vignette(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    let radius = (pixel - vignetting.centre_px) * vignetting.per_corner_px;
    let share = vignette_transmittance(dot(radius, radius), vignetting.falloff);
    return vec4<f32>(color.rgb * share, color.a);
}
