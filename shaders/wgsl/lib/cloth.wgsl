// Cloth, the sheen lobe of glTF: a lobe that is brightest at the silhouette, from upright fibers.
//
// alpha = roughness². The lobe has no masking term of its own and is not compensated for
// multiple scattering; its albedo is the third channel of the DFG table.

import package::lib::math::PI;
import package::lib::real::{real, real3};

/// Minimum denominator in `v_neubelt`; nov ≥ 1e-4 never reaches that of half floats.
@if(HALF)
const NEUBELT_FLOOR: real = 6.2e-5;
@else
const NEUBELT_FLOOR: real = 1.5e-5;

/// Evaluates Estevez and Kulla's "Charlie" sheen distribution in 1/sr, (2 + 1/α)·sin^(1/α) / 2π
/// ("Production Friendly Microfacet Sheen BRDF", 2017). sin² is at least 2⁻⁷, which half floats can
/// hold, so the base of the power is never zero (hard case 12). The power is computed in f32,
/// because an exponent of 1/2α amplifies the rounding of its base.
fn d_charlie(noh: real, alpha: real) -> real {
    let c = f32(clamp(noh, 0.0, 1.0));
    let sin2 = max((1.0 - c) * (1.0 + c), 0.0078125);
    let inverse = 1.0 / max(f32(alpha), 4e-4);
    return real((2.0 + inverse) * pow(sin2, 0.5 * inverse) * (0.5 / PI));
}

/// Evaluates the visibility of Ashikhmin and Premože ("Distribution-based BRDFs", 2007) in the form
/// of Neubelt and Pettineo ("Crafting a Next-Gen Material Pipeline for The Order: 1886", 2013). It
/// is smooth at the horizon, where 1/(4·nov·nol) would be infinite. At most 16667.
fn v_neubelt(nov: real, nol: real) -> real {
    return 0.25 / max(nol + nov - nol * nov, NEUBELT_FLOOR);
}

/// Returns the attenuation of layers below a sheen layer, 1 - max(color)·albedo. `cloth_albedo` is
/// the third channel of the DFG table (KHR_materials_sheen).
fn sheen_attenuation(sheen_color: real3, cloth_albedo: real) -> real {
    let strongest = max(sheen_color.x, max(sheen_color.y, sheen_color.z));
    return 1.0 - saturate(strongest * cloth_albedo);
}
