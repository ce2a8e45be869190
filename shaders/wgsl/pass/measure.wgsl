// Measure: the most and the least of what a picture has, for decisions on the CPU.
//
// `fs_light` and `fs_depth` take eight by eight texels of the picture to one, `fs_smaller` eight by
// eight of those. The CPU reads what is left.

import package::lib::bloom::brightest;
import package::lib::fullscreen::fullscreen_position;
import package::lib::numerics::saturate_half3;

/// Texels to a side of what one texel stands for.
const MEASURED_SIDE: i32 = 8;

/// Pre-exposed radiance, of one sample per texel.
@group(0) @binding(0) var hdr: texture_2d<f32>;
/// Its depth, reversed; of the same size.
@group(0) @binding(1) var scene_depth: texture_2d<f32>;
/// The most and the least so far.
@group(0) @binding(2) var measured: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// A texel of those that the texel at `position` stands for, the last of a row or column where
/// there are no more.
fn measured_texel(position: vec4<f32>, i: i32, size: vec2<u32>) -> vec2<i32> {
    let own = vec2<i32>(i % MEASURED_SIDE, i / MEASURED_SIDE);
    return min(vec2<i32>(position.xy) * MEASURED_SIDE + own, vec2<i32>(size) - 1);
}

/// The brightest channel; what is not a number counts as black, as it does for bloom.
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

/// The nearest and the farthest.
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
