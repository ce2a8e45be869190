// Micro-shadows: shadows of the sun from the material's occlusion.

import package::interface::material::{SLOT_OCCLUSION, material_has, occlusion};
import package::lib::micro_shadow::micro_shadowing;
import package::shading::quality::MICRO_SHADOWS;

/// Returns the visibility of the sun at a normal whose cosine to the sun is `nol`; 1 without an
/// occlusion texture.
fn micro_visibility(uv: vec4<f32>, nol: f32) -> f32 {
    if !MICRO_SHADOWS || !material_has(SLOT_OCCLUSION) {
        return 1.0;
    }
    return micro_shadowing(nol, saturate(occlusion(uv)));
}
