//! Mirror of `SkyUniforms` of `wgsl/pass/sky.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};

use crate::reference::sky::Preetham;

/// Coefficients of Preetham's clear sky, pre-exposed.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SkyUniforms {
    /// Perez coefficients A…E for (x, y, Y); w is unused.
    pub perez: [Vec4; 5],
    /// (x, y, Y) at the zenith divided by the Perez function there; Y in pre-exposed nits.
    pub zenith: Vec3,
    /// 1 - cos of the angular radius of the sun's disc, if it has a halo.
    pub disc_versine: f32,
    /// Pre-exposed radiance below the horizon, or of the whole constant sky.
    pub ground: Vec3,
    /// Reciprocal of the difference between the versines of the halo and of the disc.
    pub per_halo: f32,
    /// Unit vector toward the sun for which the coefficients were computed.
    pub toward_sun: Vec3,
    /// Exponent of the halo's falloff.
    pub halo_falloff: f32,
}

impl SkyUniforms {
    /// Packs a sky, with `exposure` in 1/nits.
    pub fn new(sky: &Preetham, exposure: f32) -> Self {
        let exposure = f64::from(exposure);
        let mut zenith = sky.zenith;
        zenith.z *= exposure;
        Self {
            perez: sky.perez.map(|coefficient| coefficient.extend(0.0).as_vec4()),
            zenith: zenith.as_vec3(),
            ground: (sky.ground * exposure).as_vec3(),
            toward_sun: sky.to_sun.as_vec3(),
            ..Self::default()
        }
    }

    /// Creates a sky of constant pre-exposed radiance, for the entry point `fs_constant`.
    pub fn constant(radiance: Vec3) -> Self {
        Self { ground: radiance, ..Self::default() }
    }

    /// Adds a sun disc with an angular radius in radians and a halo of `size` times this radius, with `size` above 1.
    /// The falloff exponent must be above 0. For the feature `SUN_HALO`.
    #[must_use]
    pub fn with_halo(self, radius_rad: f32, size: f32, falloff: f32) -> Self {
        // 1 - cos, computed from the half angle.
        let versine = |angle: f64| 2.0 * (0.5 * angle).sin().powi(2);
        let radius = f64::from(radius_rad);
        let disc = versine(radius);
        let halo = versine((radius * f64::from(size)).min(std::f64::consts::PI));
        let per_halo = 1.0 / (halo - disc).max(1e-12);
        Self { disc_versine: disc as f32, per_halo: per_halo as f32, halo_falloff: falloff, ..self }
    }
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(SkyUniforms { perez, zenith, disc_versine, ground, per_halo, toward_sun, halo_falloff })]
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    /// Verifies that exposure scales the luminance Y and the ground without a change of hue.
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
