// Sharpens an image by contrast (lib/sharpen.wgsl). The input is the encoded image after upscaling,
// or radiance after temporal anti-aliasing, where colors brighter than white stay unchanged.

import package::lib::fullscreen::fullscreen_position;
import package::lib::sharpen::sharpened;
import package::lib::srgb::linear_from_srgb;

/// Settings. Mirrored by `layout::SharpenUniforms`.
struct SharpenUniforms {
    /// Strength, 0…1.
    @size(16) strength: f32,
}

/// True decodes the encoded result, for an sRGB target.
override DECODE: bool = false;

@group(0) @binding(0) var<uniform> sharpening: SharpenUniforms;
@group(0) @binding(1) var picture: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// Returns a texel, clamped to the border.
fn texel(at: vec2<i32>) -> vec4<f32> {
    let last = vec2<i32>(textureDimensions(picture)) - 1;
    return textureLoad(picture, clamp(at, vec2<i32>(0), last), 0);
}

@fragment
fn fs_main(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<i32>(position.xy);
    let middle = texel(at);
    let color = sharpened(
        middle.rgb,
        texel(at - vec2<i32>(0, 1)).rgb,
        texel(at - vec2<i32>(1, 0)).rgb,
        texel(at + vec2<i32>(1, 0)).rgb,
        texel(at + vec2<i32>(0, 1)).rgb,
        sharpening.strength,
    );
    return vec4<f32>(select(color, linear_from_srgb(color), DECODE), middle.a);
}
