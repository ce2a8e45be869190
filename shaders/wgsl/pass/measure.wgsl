// Measure: finds the maximum and minimum of an image, for decisions on the CPU.
//
// `fs_light` and `fs_depth` reduce 8×8 pixels of the image to one texel, and `fs_smaller` reduces
// 8×8 of these texels to one. The CPU reads the final result.

import package::lib::bloom::brightest;
import package::lib::fullscreen::fullscreen_position;
import package::lib::numerics::saturate_half3;

/// Side length of the area that one texel represents, in source texels.
const MEASURED_SIDE: i32 = 8;

/// Pre-exposed radiance, single-sampled.
@group(0) @binding(0) var hdr: texture_2d<f32>;
/// Reversed depth, of the same size as the radiance.
@group(0) @binding(1) var scene_depth: texture_2d<f32>;
/// Intermediate maximum and minimum.
@group(0) @binding(2) var measured: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// Returns one of the source texels of the texel at `position`, clamped to the image border.
fn measured_texel(position: vec4<f32>, i: i32, size: vec2<u32>) -> vec2<i32> {
    let own = vec2<i32>(i % MEASURED_SIDE, i / MEASURED_SIDE);
    return min(vec2<i32>(position.xy) * MEASURED_SIDE + own, vec2<i32>(size) - 1);
}

/// Finds the brightest channel; NaN counts as black, as in bloom.
@fragment
fn fs_light(@builtin(position) position: vec4<f32>) -> @location(0) vec2<f32> {
    var found = vec2<f32>(0.0, 65504.0);
    for (var i = 0; i < MEASURED_SIDE * MEASURED_SIDE; i++) {
        let at = measured_texel(position, i, textureDimensions(hdr, 0));
        let light = brightest(saturate_half3(textureLoad(hdr, at, 0).rgb));
        found = vec2<f32>(max(found.x, light), min(found.y, light));
    }
    return found;
}

/// Finds the nearest and the farthest depth.
@fragment
fn fs_depth(@builtin(position) position: vec4<f32>) -> @location(0) vec2<f32> {
    var found = vec2<f32>(0.0, 1.0);
    for (var i = 0; i < MEASURED_SIDE * MEASURED_SIDE; i++) {
        let at = measured_texel(position, i, textureDimensions(scene_depth, 0));
        let depth = textureLoad(scene_depth, at, 0).r;
        found = vec2<f32>(max(found.x, depth), min(found.y, depth));
    }
    return found;
}

@fragment
fn fs_smaller(@builtin(position) position: vec4<f32>) -> @location(0) vec2<f32> {
    var found = vec2<f32>(0.0, 65504.0);
    for (var i = 0; i < MEASURED_SIDE * MEASURED_SIDE; i++) {
        let at = measured_texel(position, i, textureDimensions(measured, 0));
        let both = textureLoad(measured, at, 0).rg;
        found = vec2<f32>(max(found.x, both.x), min(found.y, both.y));
    }
    return found;
}
