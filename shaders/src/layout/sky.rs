//! Mirror of `SkyUniforms` of `wgsl/pass/sky.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

use crate::reference::sky::Preetham;

/// Coefficients of Preetham's clear sky, pre-exposed.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SkyUniforms {
    /// Perez' A…E for (x, y, Y); w is unused.
    pub perez: [Vec4; 5],
    /// (x, y, Y) at the zenith over Perez' function there; Y in pre-exposed nits.
    pub zenith: Vec3,
    /// 1 shows the sun's disc, 0 hides it.
    pub sun_disc: f32,
    /// Pre-exposed radiance below the horizon, or everywhere where it is constant.
    pub ground: Vec3,
    /// Padding to 16 bytes; zero.
    pub _pad0: f32,
    /// Unit vector toward the sun that the sky was made for.
    pub toward_sun: Vec3,
    /// Padding to 16 bytes; zero.
    pub _pad1: f32,
}

impl SkyUniforms {
    /// Packs a sky. `exposure` in 1/nits.
    pub fn new(sky: &Preetham, exposure: f32, sun_disc: bool) -> Self {
        let exposure = f64::from(exposure);
        let mut zenith = sky.zenith;
        zenith.z *= exposure;
        Self {
            perez: sky.perez.map(|coefficient| coefficient.extend(0.0).as_vec4()),
            zenith: zenith.as_vec3(),
            sun_disc: f32::from(u8::from(sun_disc)),
            ground: (sky.ground * exposure).as_vec3(),
            _pad0: 0.0,
            toward_sun: sky.to_sun.as_vec3(),
            _pad1: 0.0,
        }
    }

    /// The same pre-exposed radiance everywhere, for the entry point `fs_constant`.
    pub fn constant(radiance: Vec3) -> Self {
        Self { ground: radiance, ..Self::default() }
    }
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(SkyUniforms { perez, zenith, sun_disc, ground, _pad0, toward_sun, _pad1 })]
}
