//! Mirror of `wgsl/interface/fog.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// Fog of a view.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FogUniforms {
    /// Pre-exposed radiance, linear Rec.709; a tint if `of_environment` is 1.
    pub color: Vec3,
    /// Density at the eye, in 1/m.
    pub density: f32,
    /// Height falloff of the density, in 1/m.
    pub falloff: f32,
    /// Distance from the eye at which fog begins, in m.
    pub start_m: f32,
    /// Distance beyond which surfaces have no fog, in m.
    pub cut_off_m: f32,
    /// Maximum opacity, 0…1.
    pub most_opacity: f32,
    /// Distance from the eye at which in-scattering of sunlight begins, in m.
    pub glow_start_m: f32,
    /// Exponent of the sun's glow, above 0.
    pub glow_size: f32,
    /// 1: adds the sun's glow. 0: no glow.
    pub glows: f32,
    /// 1: uses the density where fog begins. 0: as in Filament.
    pub exact: f32,
    /// 1: takes the color from the environment. 0: uses `color` alone.
    pub of_environment: f32,
    /// Reciprocal of the distance at which the environment is `sharp_levels` sharper, in 1/m.
    pub per_sharp_m: f32,
    /// Number of mip levels by which the environment gets sharper with distance.
    pub sharp_levels: f32,
    /// Padding to 16 bytes; zero.
    pub _pad: f32,
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(FogUniforms {
        color,
        density,
        falloff,
        start_m,
        cut_off_m,
        most_opacity,
        glow_start_m,
        glow_size,
        glows,
        exact,
        of_environment,
        per_sharp_m,
        sharp_levels,
        _pad,
    })]
}
