// The split sum's second factor, E(f0) = ∫ f cos, and what it is used for.
//
// A table holds, over (nov, perceptual roughness), x = ∫ D·V·Fc·cos and y = ∫ D·V·cos with
// Fc = (1 - voh)⁵ (Karis 2013; Lazarov 2013). It is drawn by pass/dfg.wgsl, by visible-normal
// sampling with the same V as the shader: 64² texels err at most 0.006. Analytic fits are
// cheaper but must not feed the compensation below: Karis's mobile fit is off by 0.39 at
// f0 = 1.

import package::lib::real::{real, real2, real3};

/// Texture coordinates of (nov, roughness) in a table of `size`² texels whose first and last
/// texel centres are the parameters 0 and 1. Without the half-texel remap the ends of the
/// table would be extrapolated (hard case 14).
fn dfg_uv(nov: f32, roughness: f32, size: f32) -> vec2<f32> {
    let p = saturate(vec2<f32>(nov, roughness));
    return (p * (size - 1.0) + 0.5) / size;
}

/// Directional albedo of the specular lobe, E = f90·x + f0·(y - x), in [0, 1].
fn specular_albedo(f0: real3, f90: real, dfg: real2) -> real3 {
    return mix(real3(f90 * dfg.x), real3((f90 - 1.0) * dfg.x + dfg.y), f0);
}

/// Returns the factor that compensates for energy lost in multiple scattering, 1 + f0·(1/y - 1). It
/// is exact for f0 = 1, and within 2 % on average below (Turquin, "Practical multiple scattering
/// compensation for microfacet models", 2019). y is at least 1 - ln 2 = 0.307 in a valid table;
/// smaller values are clamped to 0.3 (hard case 13).
fn energy_compensation(f0: real3, dfg_y: real) -> real3 {
    return real3(1.0) + f0 * (1.0 / clamp(dfg_y, 0.3, 1.0) - 1.0);
}
