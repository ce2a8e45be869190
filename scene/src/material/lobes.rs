//! What a surface may have beside the metal-rough base: each a lobe of its own, in glTF's terms.
//!
//! A material holds a lobe only where it shows: importers leave out what a zero factor switches off, so the set of lobes
//! in a scene is the set of effects that it calls for.

use glam::Vec3;

use crate::texture::TextureSlot;

/// A thin layer of varnish (KHR_materials_clearcoat): a second specular lobe over everything else.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClearCoat {
    /// How much of the surface is coated, 0…1.
    pub factor: f32,
    /// Perceptual roughness of the coat, 0…1.
    pub roughness: f32,
    /// Scales x and y of the coat's tangent-space normal.
    pub normal_scale: f32,
    /// R factor; role `Linear`.
    pub texture: Option<TextureSlot>,
    /// G roughness; role `Linear`.
    pub roughness_texture: Option<TextureSlot>,
    /// Tangent-space normal; without it the coat is as smooth as the mesh. Role `Normal`.
    pub normal_texture: Option<TextureSlot>,
}

/// Fibers that stand up from the surface (KHR_materials_sheen): brightest at the silhouette.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sheen {
    /// Reflectance of the fibers, linear Rec.709, 0…1.
    pub color: Vec3,
    /// Perceptual roughness 0…1: how far the fibers spread.
    pub roughness: f32,
    /// RGB color; role `Color`.
    pub color_texture: Option<TextureSlot>,
    /// A roughness; role `Linear`.
    pub roughness_texture: Option<TextureSlot>,
}

/// Grooves along a direction of the surface (KHR_materials_anisotropy): highlights are stretched along it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Anisotropy {
    /// How far roughness along the direction grows towards 1, 0…1.
    pub strength: f32,
    /// From the tangent to the direction, counter-clockwise in the tangent plane, in radians.
    pub rotation_rad: f32,
    /// RG direction in −1…1, B strength; role `Linear`.
    pub texture: Option<TextureSlot>,
}

/// Light that passes through the surface (KHR_materials_transmission) into what lies behind it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Transmission {
    /// How much of the light that enters is transmitted and not scattered diffusely, 0…1.
    pub factor: f32,
    /// R factor; role `Linear`.
    pub texture: Option<TextureSlot>,
    /// What lies behind the surface; none is a thin wall, which does not refract.
    pub volume: Option<Volume>,
}

/// The inside of a transmitting body (KHR_materials_volume).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volume {
    /// Depth of the body under the surface in units of the mesh, above 0.
    pub thickness: f32,
    /// G thickness; role `Linear`.
    pub thickness_texture: Option<TextureSlot>,
    /// What white light becomes over `attenuation_distance_m`, linear Rec.709, 0…1.
    pub attenuation_color: Vec3,
    /// In meters of the world, above 0; infinity absorbs nothing.
    pub attenuation_distance_m: f32,
}

/// Strength and tint of a dielectric's reflection (KHR_materials_specular); metals have their base color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specular {
    /// Factor on the whole reflection, 0…1.
    pub factor: f32,
    /// Factor on reflectance at normal incidence, linear Rec.709, 0 or more; the product is held at 1.
    pub color: Vec3,
    /// A factor; role `Linear`.
    pub texture: Option<TextureSlot>,
    /// RGB color; role `Color`.
    pub color_texture: Option<TextureSlot>,
}

impl Default for Volume {
    /// Clear, a unit thick.
    fn default() -> Self {
        Self {
            thickness: 1.0,
            thickness_texture: None,
            attenuation_color: Vec3::ONE,
            attenuation_distance_m: f32::INFINITY,
        }
    }
}

impl Default for Specular {
    /// As if it were not there.
    fn default() -> Self {
        Self { factor: 1.0, color: Vec3::ONE, texture: None, color_texture: None }
    }
}

impl Volume {
    /// How much of each channel is absorbed a meter (Beer and Lambert): −ln(color) / distance.
    ///
    /// A black channel counts as a millionth, so that the result is finite.
    #[must_use]
    pub fn absorption_per_m(&self) -> Vec3 {
        let optical_depth = -self.attenuation_color.clamp(Vec3::splat(1e-6), Vec3::ONE).map(f32::ln);
        // No distance is no information, not absorption without bounds.
        optical_depth / self.attenuation_distance_m.max(1e-6)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn light_becomes_the_attenuation_color_over_the_attenuation_distance() {
        let color = Vec3::new(0.9, 0.5, 0.1);
        let volume = Volume { attenuation_color: color, attenuation_distance_m: 0.25, ..Volume::default() };
        let left = (-volume.absorption_per_m() * 0.25).map(f32::exp);
        assert!((left - color).abs().max_element() < 1e-6, "{left}");
        assert_eq!(Volume::default().absorption_per_m(), Vec3::ZERO);
        let black = Volume { attenuation_color: Vec3::ZERO, attenuation_distance_m: 1e-30, ..Volume::default() };
        assert!(black.absorption_per_m().is_finite());
    }
}
