// Shadows that a surface's own small shape throws, from ambient occlusion alone.

/// Share of a light that reaches the ground of a cavity whose ambient visibility is `visibility`,
/// 0…1, with the light `nol` over the surface: nothing until the light looks into the cavity's
/// opening (Chan, "Material Advances in Call of Duty: WWII", 2018).
fn micro_shadowing(nol: f32, visibility: f32) -> f32 {
    let aperture = inverseSqrt(1.0 - min(visibility, 0.9999));
    let lit = saturate(nol * aperture);
    return lit * lit;
}
