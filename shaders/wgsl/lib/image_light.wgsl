// The prefiltered environment: which level of the specular cube holds which roughness.
//
// Level 0 is the environment as it is, the last level is filtered with roughness 1. Roughness
// is spaced so that smooth lobes, whose look changes fastest, get more of the levels: with
// five levels they hold 0, 0.134, 0.293, 0.5 and 1. A linear spacing would double the error.

/// Level to sample, fractional, for a perceptual roughness; `roughness_one_lod` is the number
/// of the last level.
fn specular_lod(roughness: f32, roughness_one_lod: f32) -> f32 {
    let r = saturate(roughness);
    return roughness_one_lod * r * (2.0 - r);
}

/// Perceptual roughness a level is filtered with: the inverse of `specular_lod`.
fn roughness_from_specular_lod(lod: f32, roughness_one_lod: f32) -> f32 {
    return 1.0 - sqrt(saturate(1.0 - lod / max(roughness_one_lod, 1e-6)));
}
