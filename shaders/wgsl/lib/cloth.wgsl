// Cloth, the sheen lobe of glTF: a lobe that is brightest at the silhouette, from upright fibers.
//
// alpha = roughness². The lobe has no masking term of its own and is not compensated for
// multiple scattering; its albedo is the third channel of the DFG table.

import package::lib::math::PI;
import package::lib::real::{real, real3};

/// What `v_neubelt` divides by at least; nov ≥ 1e-4 never reaches the half float's.
@if(HALF)
const NEUBELT_FLOOR: real = 6.2e-5;
@else
const NEUBELT_FLOOR: real = 1.5e-5;

/// Estevez and Kulla's "Charlie" sheen distribution ("Production Friendly Microfacet Sheen
/// BRDF", 2017), in 1/sr: (2 + 1/α)·sin^(1/α) / 2π. sin² is held above 2⁻⁷, where a half float
/// still has it, so that the power of zero never arises (hard case 12). The power is taken in
/// f32: an exponent of 1/2α magnifies the rounding of its base.
fn d_charlie(noh: real, alpha: real) -> real {
    let c = f32(clamp(noh, 0.0, 1.0));
    let sin2 = max((1.0 - c) * (1.0 + c), 0.0078125);
    let inverse = 1.0 / max(f32(alpha), 4e-4);
    return real((2.0 + inverse) * pow(sin2, 0.5 * inverse) * (0.5 / PI));
}

/// Visibility of Ashikhmin and Premože ("Distribution-based BRDFs", 2007) as Neubelt and
/// Pettineo use it ("Crafting a Next-Gen Material Pipeline for The Order: 1886", 2013):
/// smooth at the horizon, where 1/(4·nov·nol) would explode. At most 16667.
fn v_neubelt(nov: real, nol: real) -> real {
    return 0.25 / max(nol + nov - nol * nov, NEUBELT_FLOOR);
}

/// What a sheen layer leaves for the layers below it: 1 - max(color)·albedo, where
/// `cloth_albedo` is the third channel of the DFG table (KHR_materials_sheen).
fn sheen_attenuation(sheen_color: real3, cloth_albedo: real) -> real {
    let strongest = max(sheen_color.x, max(sheen_color.y, sheen_color.z));
    return 1.0 - saturate(strongest * cloth_albedo);
}
