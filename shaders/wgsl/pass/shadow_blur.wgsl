// Blurs the moments of a shadow map along one axis, or halves them.

import package::lib::fullscreen::fullscreen_position;

/// Settings of a blur along one axis. Mirrored by `layout::ShadowBlurUniforms`.
struct ShadowBlurUniforms {
    /// Step of one texel along the axis: (1, 0) or (0, 1).
    step: vec2<i32>,
    /// -1 / (2 σ²) of the Gaussian, σ in texels.
    falloff: f32,
    /// First texel of the map; reads are clamped to it.
    first: vec2<i32>,
    /// Last texel of the map; reads are clamped to it.
    last: vec2<i32>,
}

/// Number of taps on each side.
override REACH: i32 = 1;

@group(0) @binding(0) var<uniform> shadow_blur: ShadowBlurUniforms;
/// One mip level of one layer.
@group(0) @binding(1) var moments: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(index, 0.0);
}

/// Applies a Gaussian along one axis, clamped to the map's edge.
@fragment
fn fs_blur(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let center = vec2<i32>(at.xy);
    var sum = vec2<f32>(0.0);
    var weights = 0.0;
    for (var i = -REACH; i <= REACH; i++) {
        let weight = exp(shadow_blur.falloff * f32(i * i));
        let texel = clamp(center + shadow_blur.step * i, shadow_blur.first, shadow_blur.last);
        sum += textureLoad(moments, texel, 0).xy * weight;
        weights += weight;
    }
    return vec4<f32>(sum / weights, 0.0, 0.0);
}

/// Averages four texels.
@fragment
fn fs_halve(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let last = vec2<i32>(textureDimensions(moments)) - 1;
    let corner = vec2<i32>(at.xy) * 2;
    var sum = vec2<f32>(0.0);
    for (var i = 0; i < 4; i++) {
        sum += textureLoad(moments, min(corner + vec2<i32>(i & 1, i >> 1u), last), 0).xy;
    }
    return vec4<f32>(sum * 0.25, 0.0, 0.0);
}
