// Effect: the image fades into a color toward its edges.

import package::lib::vignette::edge_share;

/// Settings of `edge_fade`. Mirrored by `layout::EdgeFadeUniforms`.
struct EdgeFadeUniforms {
    /// See `edge_share`.
    shape: vec4<f32>,
    /// Factor on light at the edges; linear Rec.709.
    @size(16) color: vec3<f32>,
    /// Center of the fade, in pixels.
    middle_px: vec2<f32>,
    /// Reciprocal of the size of the fade, in 1/pixels.
    per_px: vec2<f32>,
}

@group(0) @binding(0) var<uniform> fading: EdgeFadeUniforms;

/// Multiplies scene-referred linear light by the color at the edges; alpha is unchanged.
fn edge_fade(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    let left = edge_share((pixel - fading.middle_px) * fading.per_px, fading.shape);
    return vec4<f32>(color.rgb * mix(fading.color, vec3<f32>(1.0), left), color.a);
}
