// Effect: the tone curve, from scene-referred light to display light.

import package::lib::tone_map::tone_map;

/// The curve, a TONE_MAP_* of lib/tone_map.wgsl.
override TONE_MAP: u32 = 1u;

/// Linear display light in [0, 1]; alpha stays.
fn tone(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    return vec4<f32>(tone_map(color.rgb, TONE_MAP), color.a);
}
