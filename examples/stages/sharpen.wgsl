// Sharpen: unsharp mask on the sRGB-encoded final picture, which is perceptually uniform.

import package::lib::fullscreen::fullscreen_position;
import package::lib::srgb::linear_from_srgb;

/// Weight of the difference to the mean of the neighbors; 0 changes nothing.
override STRENGTH: f32 = 0.5;
/// True writes encoded values to a Unorm target, false writes linear values to an sRGB target.
override OUTPUT_ENCODED: bool = false;

/// Picture, sRGB-encoded in a linear format.
@group(0) @binding(0) var picture: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// Returns the texel at `at`, clamped to the picture.
fn texel(at: vec2<i32>) -> vec3<f32> {
    let last = vec2<i32>(textureDimensions(picture)) - 1;
    return textureLoad(picture, clamp(at, vec2<i32>(0), last), 0).rgb;
}

@fragment
fn fs_main(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<i32>(position.xy);
    let here = texel(at);
    let around = 0.25
        * (texel(at + vec2<i32>(1, 0)) + texel(at - vec2<i32>(1, 0)) + texel(at + vec2<i32>(0, 1)) + texel(at - vec2<i32>(0, 1)));
    let encoded = saturate(here + STRENGTH * (here - around));
    return vec4<f32>(select(linear_from_srgb(encoded), encoded, OUTPUT_ENCODED), 1.0);
}
