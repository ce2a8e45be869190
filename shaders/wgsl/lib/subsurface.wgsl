// Light scattered below a surface, by the approximations of Filament's shading models `subsurface`
// and `cloth`. They conserve no energy.

import package::lib::math::PI;
import package::lib::real::{real, real3};

/// BSDF times cosine, in 1/sr, of the light that is scattered below a surface of color one. `vol`
/// is view · light, `nol` normal · light; `power` is the exponent of the lobe toward lights
/// behind the surface, 0 or more, and `thickness` 0…1. The lobe is a spherical Gaussian in place
/// of a power, in f32: half floats hold neither its exponent nor what is left of it.
fn subsurface_scatter(vol: real, nol: real, power: f32, thickness: f32) -> f32 {
    let forward = exp2((saturate(-f32(vol)) - 1.0) * power);
    let back = 0.5 * (saturate(f32(nol)) * thickness + (1.0 - thickness));
    return mix(back, 1.0, forward) * (1.0 - thickness) * (1.0 / PI);
}

/// Factor on the sum of irradiance / π at the normal and radiance from behind that is scattered
/// below a surface of that thickness, 0…1.
fn subsurface_ambient(thickness: f32) -> f32 {
    return (1.0 - thickness) * (0.5 / PI);
}

/// Perceptual roughness of the level of the prefiltered environment that stands for light through
/// a body, where the surface has `alpha`. Filament adds 1 + thickness to the level, of four.
fn subsurface_roughness(alpha: f32, thickness: f32) -> f32 {
    return 1.0 - sqrt(1.0 - saturate(alpha + 0.25 * (1.0 + thickness)));
}

/// Cosine wrapped half about the terminator, 0…1: Filament's `Fd_Wrap` of 0.5. Over the sphere of
/// directions it sums up to that of the cosine.
fn wrapped_cosine(nol: real) -> real {
    return saturate((nol + 0.5) * (1.0 / 2.25));
}

/// Returns the tint of light scattered by cloth: the color in the shadow, white in full light.
/// The cosine is that of the light or, for ambient light, of the viewer.
fn cloth_tint(color: real3, cosine: real) -> real3 {
    return saturate(color + saturate(cosine));
}
