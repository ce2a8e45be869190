// Moments of a shadow map, blurred along one axis or halved.

import package::lib::fullscreen::fullscreen_position;

/// A blur along one axis. Mirrored by `layout::ShadowBlurUniforms`.
struct ShadowBlurUniforms {
    /// One texel along the axis: (1, 0) or (0, 1).
    step: vec2<i32>,
    /// -1 / (2 σ²) of the Gaussian, σ in texels.
    falloff: f32,
    /// First and last texel of the map: beyond lies its edge.
    first: vec2<i32>,
    /// See `first`.
    last: vec2<i32>,
}

/// Taps on each side.
override REACH: i32 = 1;

@group(0) @binding(0) var<uniform> shadow_blur: ShadowBlurUniforms;
/// A layer, a level of it.
@group(0) @binding(1) var moments: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(index, 0.0);
}

/// A Gaussian along one axis; beyond the map's edge lies the edge.
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

/// The mean of four texels.
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
