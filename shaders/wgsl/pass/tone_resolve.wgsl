// MSAA resolve that averages samples approximately as displayed. Brighter samples have lower
// weight, so that edges next to bright areas are as smooth as others (Karis, "Tone mapping", 2013;
// Filament's custom resolve). Equal samples stay unchanged.

import package::lib::bloom::firefly_weight;
import package::lib::fullscreen::fullscreen_position;
import package::lib::numerics::saturate_half3;

/// Number of samples per texel: OpenGL ES cannot query it.
override SAMPLES: i32 = 4;

@group(0) @binding(0) var hdr_samples: texture_multisampled_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

@fragment
fn fs_main(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let texel = vec2<i32>(position.xy);
    let samples = max(SAMPLES, 1);
    var sum = vec3<f32>(0.0);
    var whole = 0.0;
    var alpha = 0.0;
    for (var i = 0; i < samples; i++) {
        let found = textureLoad(hdr_samples, texel, i);
        let color = saturate_half3(found.rgb);
        let weight = firefly_weight(color);
        sum += weight * color;
        whole += weight;
        alpha += found.a;
    }
    return vec4<f32>(sum / whole, alpha / f32(samples));
}
