// Effect: the picture fades into a color toward its edges.

import package::lib::vignette::edge_share;

/// Settings of `edge_fade`. Mirrored by `layout::EdgeFadeUniforms`.
struct EdgeFadeUniforms {
    /// See `edge_share`.
    shape: vec4<f32>,
    /// What the edges become, a factor on light; linear Rec.709.
    @size(16) color: vec3<f32>,
    /// One over the size of the picture in pixels.
    @size(16) per_px: vec2<f32>,
}

@group(0) @binding(0) var<uniform> fading: EdgeFadeUniforms;

/// Scene-referred linear light times the color at the edges; alpha stays.
fn edge_fade(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    let left = edge_share(pixel * fading.per_px - 0.5, fading.shape);
    return vec4<f32>(color.rgb * mix(fading.color, vec3<f32>(1.0), left), color.a);
}
