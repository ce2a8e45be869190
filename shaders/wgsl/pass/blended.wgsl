// Compositing of order-independent transparency over the opaque surfaces.
//
// `fs_main` reads single-sampled textures; `fs_samples` composites each sample of multisampled
// textures. The result passes through the epilogue (interface/epilogue.wgsl) before it is written.

import package::interface::epilogue::epilogue;
import package::lib::fullscreen::fullscreen_position;
import package::lib::moment_transparency::transmittance_of;
import package::lib::numerics::{saturate_half, saturate_half3};

/// Contents of the sums. 0: weighted colors, and transmittance in red. 1: weighted colors, and
/// absorbance in red. 2: color of peeled layers, and their transmittance in alpha.
override SUMS: u32 = 0u;

/// Pre-exposed radiance of the opaque surfaces.
@group(0) @binding(0) var behind: texture_2d<f32>;
@group(0) @binding(1) var behind_samples: texture_multisampled_2d<f32>;
/// Sums of color and alpha, both multiplied by the weight.
@group(0) @binding(2) var accumulated: texture_2d<f32>;
@group(0) @binding(3) var accumulated_samples: texture_multisampled_2d<f32>;
/// Transmittance or absorbance in red.
@group(0) @binding(4) var let_through: texture_2d<f32>;
@group(0) @binding(5) var let_through_samples: texture_multisampled_2d<f32>;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

/// Returns the blended surfaces composited over the background.
fn composed(behind: vec4<f32>, sums: vec4<f32>, red: f32) -> vec4<f32> {
    let colors = saturate_half3(sums.rgb);
    if SUMS == 2u {
        return vec4<f32>(saturate_half3(colors + behind.rgb * saturate(sums.a)), behind.a);
    }
    var through = saturate(red);
    if SUMS == 1u {
        through = transmittance_of(red);
    }
    // Smallest half float above zero: surfaces with zero weight leave no color.
    let mean = colors / max(saturate_half(sums.a), 6e-8);
    return vec4<f32>(saturate_half3(mean * (1.0 - through) + behind.rgb * through), behind.a);
}

/// Single-sampled textures.
@fragment
fn fs_main(@builtin(position) position: vec4<f32>) -> @location(4) vec4<f32> {
    let texel = vec2<i32>(position.xy);
    let color = composed(
        textureLoad(behind, texel, 0),
        textureLoad(accumulated, texel, 0),
        textureLoad(let_through, texel, 0).r,
    );
    return epilogue(color, position.xy);
}

/// Multisampled textures, per sample.
@fragment
fn fs_samples(
    @builtin(position) position: vec4<f32>,
    @builtin(sample_index) index: u32,
) -> @location(4) vec4<f32> {
    let texel = vec2<i32>(position.xy);
    let color = composed(
        textureLoad(behind_samples, texel, index),
        textureLoad(accumulated_samples, texel, index),
        textureLoad(let_through_samples, texel, index).r,
    );
    return epilogue(color, position.xy);
}
