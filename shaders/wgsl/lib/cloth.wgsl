// Cloth: a lobe that is brightest at the silhouette, from fibers that stand up.
//
// alpha = roughness². The lobe has no masking term of its own and is not compensated for
// multiple scattering; its albedo is the third channel of the DFG table.

import package::lib::math::PI;

/// Estevez and Kulla's "Charlie" sheen distribution ("Production Friendly Microfacet Sheen
/// BRDF", 2017), in 1/sr: (2 + 1/α)·sin^(1/α) / 2π. sin² is held above 2⁻⁷, where a half float
/// still has it, so that the power of zero never arises (hard case 12).
fn d_charlie(noh: f32, alpha: f32) -> f32 {
    let c = clamp(noh, 0.0, 1.0);
    let sin2 = max((1.0 - c) * (1.0 + c), 0.0078125);
    let inverse = 1.0 / max(alpha, 4e-4);
    return (2.0 + inverse) * pow(sin2, 0.5 * inverse) * (0.5 / PI);
}

/// Visibility of Ashikhmin and Premože ("Distribution-based BRDFs", 2007) as Neubelt and
/// Pettineo use it ("Crafting a Next-Gen Material Pipeline for The Order: 1886", 2013):
/// smooth at the horizon, where 1/(4·nov·nol) would explode. At most 16667.
fn v_neubelt(nov: f32, nol: f32) -> f32 {
    return 0.25 / max(nol + nov - nol * nov, 1.5e-5);
}

/// What a sheen layer leaves for the layers below it: 1 - max(color)·albedo, where
/// `cloth_albedo` is the third channel of the DFG table (KHR_materials_sheen).
fn sheen_attenuation(sheen_color: vec3<f32>, cloth_albedo: f32) -> f32 {
    let strongest = max(sheen_color.x, max(sheen_color.y, sheen_color.z));
    return 1.0 - saturate(strongest * cloth_albedo);
}
