// Micro-shadows from ambient occlusion.

/// Returns the share of a light that reaches the bottom of a cavity. `visibility` is its ambient
/// visibility, 0…1, and `nol` the cosine of the light. Nothing arrives until the light enters the
/// cavity's opening (Chan, "Material Advances in Call of Duty: WWII", 2018).
fn micro_shadowing(nol: f32, visibility: f32) -> f32 {
    let aperture = inverseSqrt(1.0 - min(visibility, 0.9999));
    let lit = saturate(nol * aperture);
    return lit * lit;
}
