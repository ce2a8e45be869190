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
    /// Padding to 16 bytes; zero.
    pub _pad0: f32,
    /// Pre-exposed radiance below the horizon, or everywhere where it is constant.
    pub ground: Vec3,
    /// Padding to 16 bytes; zero.
    pub _pad1: f32,
    /// Unit vector toward the sun that the sky was made for.
    pub toward_sun: Vec3,
    /// Padding to 16 bytes; zero.
    pub _pad2: f32,
}

impl SkyUniforms {
    /// Packs a sky. `exposure` in 1/nits.
    pub fn new(sky: &Preetham, exposure: f32) -> Self {
        let exposure = f64::from(exposure);
        let mut zenith = sky.zenith;
        zenith.z *= exposure;
        Self {
            perez: sky.perez.map(|coefficient| coefficient.extend(0.0).as_vec4()),
            zenith: zenith.as_vec3(),
            _pad0: 0.0,
            ground: (sky.ground * exposure).as_vec3(),
            _pad1: 0.0,
            toward_sun: sky.to_sun.as_vec3(),
            _pad2: 0.0,
        }
    }

    /// The same pre-exposed radiance everywhere, for the entry point `fs_constant`.
    pub fn constant(radiance: Vec3) -> Self {
        Self { ground: radiance, ..Self::default() }
    }
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(SkyUniforms { perez, zenith, _pad0, ground, _pad1, toward_sun, _pad2 })]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// Exposure is a factor on the luminance Y and on the ground, and turns no color.
    #[test]
    fn exposure_scales_radiance_alone() {
        let sky = Preetham {
            perez: [DVec3::new(0.1, 0.2, 0.3); 5],
            zenith: DVec3::new(0.25, 0.5, 1000.0),
            ground: DVec3::new(10.0, 20.0, 40.0),
            to_sun: DVec3::Y,
        };
        let packed = SkyUniforms::new(&sky, 0.125);
        assert_eq!(packed.zenith, Vec3::new(0.25, 0.5, 125.0));
        assert_eq!(packed.ground, Vec3::new(1.25, 2.5, 5.0));
        assert_eq!((packed.perez, packed.toward_sun), ([Vec4::new(0.1, 0.2, 0.3, 0.0); 5], Vec3::Y));
    }
}
