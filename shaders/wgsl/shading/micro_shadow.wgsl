// The material's occlusion as a shadow of the sun.

import package::interface::material::{SLOT_OCCLUSION, material_has, occlusion};
import package::lib::micro_shadow::micro_shadowing;
import package::shading::quality::MICRO_SHADOWS;

/// Share of the sun that the material's occlusion leaves at a normal whose cosine to the sun is
/// `nol`; one without an occlusion texture.
fn micro_visibility(uv: vec4<f32>, nol: f32) -> f32 {
    if !MICRO_SHADOWS || !material_has(SLOT_OCCLUSION) {
        return 1.0;
    }
    return micro_shadowing(nol, saturate(occlusion(uv)));
}
