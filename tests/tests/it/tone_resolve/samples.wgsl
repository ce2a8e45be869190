// Radiance of four samples a texel, each of its own.

import package::lib::fullscreen::fullscreen_position;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

@fragment
fn fs_main(
    @builtin(position) position: vec4<f32>,
    @builtin(sample_index) index: u32,
) -> @location(0) vec4<f32> {
    let x = u32(position.x);
    if x == 1u && index == 2u {
        return vec4<f32>(300.0, 20.0, 4.0, 1.0);
    }
    if x == 2u && index == 0u {
        return vec4<f32>(1e9, 1e9, 1e9, 1.0);
    }
    if x == 3u {
        return vec4<f32>(0.0, 0.0, 7.0, 1.0);
    }
    return vec4<f32>(0.25, 0.5, 0.125, 1.0) * f32(1u + index);
}
