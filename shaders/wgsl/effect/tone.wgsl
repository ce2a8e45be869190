// Effect: the tone curve, from scene-referred light to display light.

import package::lib::tone_map::{TONE_MAP_MOBILE, tone_map, tone_map_mobile};

/// The curve, a TONE_MAP_* of lib/tone_map.wgsl.
override TONE_MAP: u32 = 1u;
/// Parameters of the generic curve: contrast, input scale, output scale.
override GENERIC_CONTRAST: f32 = 1.55;
override GENERIC_INPUT: f32 = 0.2583;
override GENERIC_OUTPUT: f32 = 1.0073;
/// Applies the curve to luminance only.
override BY_LUMINANCE: bool = false;
/// Maps colors outside the display's gamut into it instead of clipping.
override INTO_GAMUT: bool = false;

/// Returns linear display light in [0, 1]; alpha is unchanged. The mobile curve returns encoded
/// light, for `encode` with INPUT_ENCODED, except with BY_LUMINANCE or INTO_GAMUT.
fn tone(color: vec4<f32>, pixel: vec2<f32>) -> vec4<f32> {
    if TONE_MAP == TONE_MAP_MOBILE && !BY_LUMINANCE && !INTO_GAMUT {
        return vec4<f32>(tone_map_mobile(color.rgb), color.a);
    }
    let generic = vec3<f32>(GENERIC_CONTRAST, GENERIC_INPUT, GENERIC_OUTPUT);
    return vec4<f32>(tone_map(color.rgb, TONE_MAP, generic, BY_LUMINANCE, INTO_GAMUT), color.a);
}
