// Roughness of a fragment for shading.

import package::lib::specular_aa::normal_filtering;
import package::shading::quality::{
    ROUGHNESS_FLOOR, SPECULAR_AA_VARIANCE, SPECULAR_AA_THRESHOLD,
};

/// Returns the perceptual roughness for shading: at least the floor, increased by the variation of
/// the normal within the pixel.
fn shaded_roughness(roughness: f32, smooth_side: vec3<f32>) -> f32 {
    var r = clamp(roughness, ROUGHNESS_FLOOR, 1.0);
    if SPECULAR_AA_VARIANCE > 0.0 {
        let dx = dpdx(smooth_side);
        let dy = dpdy(smooth_side);
        r = normal_filtering(r, dx, dy, SPECULAR_AA_VARIANCE, SPECULAR_AA_THRESHOLD);
    }
    return r;
}
