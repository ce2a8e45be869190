// The DFG table: directional albedo of the lobes over (nov, perceptual roughness).
//
// Red is ∫ D·V·Fc·cos and green is ∫ D·V·cos of the GGX lobe, so E(f0) = mix(red, green, f0), and
// 1/green is the multiple-scattering factor. Blue is ∫ D·V·cos of the cloth lobe. The centers of
// the first and last texels are the parameters 0 and 1, as lib/dfg.wgsl expects. GGX is sampled by
// visible normals, cloth uniformly.

import package::lib::dfg_integration::{dfg_ggx, dfg_cloth};
import package::lib::fullscreen::fullscreen_position;
import package::lib::quantize::quantize_rgba16float;

/// Width and height of the table in texels, at least 2.
override TABLE_TEXELS: u32 = 128u;
/// Uses Hammon's visibility term instead of the exact one. The table must use the same term as the
/// shading.
override FAST_VISIBILITY: bool = false;
/// Samples of the GGX lobe in each texel.
override GGX_SAMPLES: u32 = 1024u;
/// Samples of the cloth lobe in each texel.
override CLOTH_SAMPLES: u32 = 1024u;

@vertex
fn vs_main(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4<f32> {
    return fullscreen_position(vertex, 0.0);
}

@fragment
fn fs_main(@builtin(position) position: vec4<f32>) -> @location(0) vec4<f32> {
    let at = floor(position.xy) / f32(TABLE_TEXELS - 1u);
    // Both limits exist, but direct evaluation gives 0/0.
    let nov = max(at.x, 1e-3);
    let roughness = max(at.y, 0.02);
    let ggx = dfg_ggx(nov, roughness, FAST_VISIBILITY, GGX_SAMPLES);
    let cloth = dfg_cloth(nov, roughness, CLOTH_SAMPLES);
    return quantize_rgba16float(vec4<f32>(ggx, cloth, 1.0), false);
}
