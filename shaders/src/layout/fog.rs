//! Mirror of `wgsl/interface/fog.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

/// The fog of a view.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FogUniforms {
    /// Pre-exposed radiance, linear Rec.709; or a tint of the environment's.
    pub color: Vec3,
    /// Density at the eye, in 1/m.
    pub density: f32,
    /// How fast density falls with height, in 1/m.
    pub falloff: f32,
    /// Where fog begins, in m from the eye.
    pub start_m: f32,
    /// What is farther away is not in fog.
    pub cut_off_m: f32,
    /// The most that it hides, 0…1.
    pub most_opacity: f32,
    /// Where the sun's light begins to be scattered, in m from the eye.
    pub glow_start_m: f32,
    /// Exponent of the glow about the sun, above 0.
    pub glow_size: f32,
    /// 1: there is a glow. 0: there is none.
    pub glows: f32,
    /// 1: density where fog begins counts. 0: as Filament has it.
    pub exact: f32,
    /// 1: the color is the environment's. 0: it is not.
    pub of_environment: f32,
    /// One over the distance from which on the environment is blurred less by `sharp_levels`, in 1/m.
    pub per_sharp_m: f32,
    /// Levels by which it is blurred less from that distance on.
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
