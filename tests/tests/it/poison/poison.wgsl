// Poison: a copy of a texture with one texel of other bits.

import package::lib::fullscreen::fullscreen_position;

/// The texel, and the bits of every channel of it.
override X: i32 = -1;
override Y: i32 = -1;
override BITS_LOW: u32 = 0u;
override BITS_HIGH: u32 = 0u;

@group(0) @binding(0) var source: texture_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

@fragment
fn fs_main(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = vec2<i32>(position.xy);
    if at.x == X && at.y == Y {
        return vec4<f32>(bitcast<f32>((BITS_HIGH << 16u) | BITS_LOW));
    }
    return textureLoad(source, at, 0);
}
