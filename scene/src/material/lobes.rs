//! Lobes that extend the metallic-roughness base of a material, in glTF's terms.
//!
//! A material has a lobe only if it is visible: importers omit lobes with a zero factor. The set of lobes in a scene is
//! thus the set of effects that it needs.

use glam::Vec3;

use crate::texture::TextureSlot;

/// Clear coat (KHR_materials_clearcoat), such as varnish or car paint: a second specular lobe over all others.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClearCoat {
    /// Coverage of the coat, 0…1.
    pub factor: f32,
    /// Perceptual roughness of the coat, 0…1.
    pub roughness: f32,
    /// Scale of the x and y components of the coat's tangent-space normal.
    pub normal_scale: f32,
    /// Texture of the factor (R); role `Linear`.
    pub texture: Option<TextureSlot>,
    /// Texture of the roughness (G); role `Linear`.
    pub roughness_texture: Option<TextureSlot>,
    /// Texture of the coat's tangent-space normals; without it the coat uses the normals of the mesh. Role `Normal`.
    pub normal_texture: Option<TextureSlot>,
    /// Keeps the base's reflectance at normal incidence as in air. By default the interface with the coat, of index
    /// 1.5, reduces it. Filament: material property `clearCoatIorChange` set to false.
    pub keeps_base_f0: bool,
}

/// Sheen (KHR_materials_sheen): reflection by fibers, brightest at silhouettes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sheen {
    /// Reflectance of the fibers, linear Rec.709, 0…1.
    pub color: Vec3,
    /// Perceptual roughness 0…1; larger values spread the fibers.
    pub roughness: f32,
    /// Texture of the color (RGB); role `Color`.
    pub color_texture: Option<TextureSlot>,
    /// Texture of the roughness (A); role `Linear`.
    pub roughness_texture: Option<TextureSlot>,
}

/// Anisotropic roughness (KHR_materials_anisotropy), as on brushed metal: highlights are stretched along a direction of
/// the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Anisotropy {
    /// Increase of the roughness along the direction: 0 for none, 1 for a roughness of 1.
    pub strength: f32,
    /// Angle from the tangent to the direction, counter-clockwise in the tangent plane, in radians.
    pub rotation_rad: f32,
    /// Texture of the direction (RG, decoded to −1…1) and the strength (B); role `Linear`.
    pub texture: Option<TextureSlot>,
}

/// Transmission (KHR_materials_transmission): light that passes through the surface without scattering.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Transmission {
    /// Fraction of the entering light that is transmitted instead of scattered diffusely, 0…1.
    pub factor: f32,
    /// Texture of the factor (R); role `Linear`.
    pub texture: Option<TextureSlot>,
    /// Volume behind the surface; `None` for a thin wall, which does not refract.
    pub volume: Option<Volume>,
}

/// Volume of a transmissive body (KHR_materials_volume).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volume {
    /// Thickness of the volume beneath the surface in mesh units, above 0.
    pub thickness: f32,
    /// Texture of the thickness (G); role `Linear`.
    pub thickness_texture: Option<TextureSlot>,
    /// Color of white light after `attenuation_distance_m`, linear Rec.709, 0…1.
    pub attenuation_color: Vec3,
    /// Distance in meters of world space, above 0; infinity for no absorption.
    pub attenuation_distance_m: f32,
}

/// Iridescence (KHR_materials_iridescence): interference of light reflected at both sides of a thin film, as on soap
/// bubbles or oil.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iridescence {
    /// Coverage of the film, 0…1.
    pub factor: f32,
    /// Texture of the factor (R); role `Linear`.
    pub texture: Option<TextureSlot>,
    /// Index of refraction of the film, 1 or more.
    pub ior: f32,
    /// Thickness of the film in nanometers at a texture value of 0.
    pub min_thickness_nm: f32,
    /// Thickness of the film in nanometers at a texture value of 1, or without a texture.
    pub max_thickness_nm: f32,
    /// Texture of the thickness (G); role `Linear`.
    pub thickness_texture: Option<TextureSlot>,
}

/// Diffuse transmission (KHR_materials_diffuse_transmission): light scattered through the surface, as in leaves, paper
/// or wax.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmission {
    /// Fraction of the scattered light that exits on the other side, 0…1.
    pub factor: f32,
    /// Texture of the factor (A); role `Linear`.
    pub texture: Option<TextureSlot>,
    /// Albedo of the light that exits on the other side, linear Rec.709, 0…1.
    pub color: Vec3,
    /// Texture of the color (RGB); role `Color`.
    pub color_texture: Option<TextureSlot>,
    /// Volume behind the surface, which absorbs light; `None` for a thin sheet.
    pub volume: Option<Volume>,
}

/// Strength and tint of a dielectric's specular reflection (KHR_materials_specular). Metals use their base color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specular {
    /// Factor on the entire reflection, 0…1.
    pub factor: f32,
    /// Factor on the reflectance at normal incidence, linear Rec.709, 0 or more; the product is clamped to 1.
    pub color: Vec3,
    /// Texture of the factor (A); role `Linear`.
    pub texture: Option<TextureSlot>,
    /// Texture of the color (RGB); role `Color`.
    pub color_texture: Option<TextureSlot>,
}

/// Subsurface scattering, as in skin, wax or leaves. It is Filament's shading model `subsurface`: an approximation that
/// does not conserve energy. In glTF files it is `{"subsurface": {...}}` in the material's extras.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subsurface {
    /// Color of the scattered light, linear Rec.709, 0…1. Filament: `subsurfaceColor`.
    pub color: Vec3,
    /// Exponent of the lobe toward lights behind the surface, 0 to [`Subsurface::MAX_POWER`]; larger values narrow it.
    /// Filament: `subsurfacePower`.
    pub power: f32,
    /// Thickness without a unit, from 0 (all light passes) to 1 (no light passes). Filament: `thickness`.
    pub thickness: f32,
}

impl Subsurface {
    /// Maximum exponent.
    pub const MAX_POWER: f32 = 10_000.0;
}

impl Default for Subsurface {
    /// Returns Filament's defaults: white, power 12.234, thickness 0.5.
    fn default() -> Self {
        Self { color: Vec3::ONE, power: 12.234, thickness: 0.5 }
    }
}

impl Default for Iridescence {
    /// Returns the extension's defaults with full coverage: index 1.3, 100 to 400 nm.
    fn default() -> Self {
        Self {
            factor: 1.0,
            texture: None,
            ior: 1.3,
            min_thickness_nm: 100.0,
            max_thickness_nm: 400.0,
            thickness_texture: None,
        }
    }
}

impl Default for DiffuseTransmission {
    /// Returns a thin white sheet that transmits all scattered light.
    fn default() -> Self {
        Self { factor: 1.0, texture: None, color: Vec3::ONE, color_texture: None, volume: None }
    }
}

impl Default for Volume {
    /// Returns a volume one mesh unit thick, without absorption.
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
    /// Returns factor and color of 1, which have no effect.
    fn default() -> Self {
        Self { factor: 1.0, color: Vec3::ONE, texture: None, color_texture: None }
    }
}

impl Volume {
    /// Returns the absorption coefficient of each channel in 1/m (Beer and Lambert): −ln(color) / distance.
    ///
    /// Channels are at least 1e-6, so that the result is finite.
    #[must_use]
    pub fn absorption_per_m(&self) -> Vec3 {
        let optical_depth = -self.attenuation_color.clamp(Vec3::splat(1e-6), Vec3::ONE).map(f32::ln);
        // A distance of zero is missing information, not infinite absorption.
        optical_depth / self.attenuation_distance_m.max(1e-6)
    }
}

/// Lobe that extends the metallic-roughness base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Lobe {
    /// Second specular layer: [`ClearCoat`].
    ClearCoat,
    /// Reflection by fibers: [`Sheen`].
    Sheen,
    /// Highlights stretched along a direction: [`Anisotropy`].
    Anisotropy,
    /// Specular transmission: [`Transmission`].
    Transmission,
    /// Strength and tint of the dielectric reflection: [`Specular`].
    Specular,
    /// Thin-film interference: [`Iridescence`].
    Iridescence,
    /// Refraction that depends on wavelength ([`Material::dispersion`](super::Material::dispersion)).
    Dispersion,
    /// Light scattered through the surface: [`DiffuseTransmission`].
    DiffuseTransmission,
    /// Light scattered below the surface: [`Subsurface`].
    Subsurface,
    /// Light scattered within cloth ([`Material::cloth_subsurface`](super::Material::cloth_subsurface)).
    ClothSubsurface,
}

impl Lobe {
    /// All lobes, in declaration order.
    pub const ALL: [Self; 10] = [
        Self::ClearCoat,
        Self::Sheen,
        Self::Anisotropy,
        Self::Transmission,
        Self::Specular,
        Self::Iridescence,
        Self::Dispersion,
        Self::DiffuseTransmission,
        Self::Subsurface,
        Self::ClothSubsurface,
    ];
}

/// Set of lobes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Lobes(u16);

impl Lobes {
    /// Empty set: the metallic-roughness base alone.
    pub const NONE: Self = Self(0);

    /// Returns the set with `lobe` added.
    #[must_use]
    pub const fn with(self, lobe: Lobe) -> Self {
        Self(self.0 | 1 << lobe as u8)
    }

    /// Returns the union of both sets.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns true if the set has no lobes.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns true if `lobe` is in the set.
    pub const fn contains(self, lobe: Lobe) -> bool {
        self.0 & 1 << lobe as u8 != 0
    }

    /// Returns the lobes of the set in declaration order.
    pub fn iter(self) -> impl Iterator<Item = Lobe> {
        Lobe::ALL.into_iter().filter(move |lobe| self.contains(*lobe))
    }
}

impl FromIterator<Lobe> for Lobes {
    fn from_iter<I: IntoIterator<Item = Lobe>>(lobes: I) -> Self {
        lobes.into_iter().fold(Self::NONE, Self::with)
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

    #[test]
    fn a_set_holds_what_was_put_in() {
        let set: Lobes = [Lobe::Specular, Lobe::Sheen].into_iter().collect();
        assert_eq!(set.iter().collect::<Vec<_>>(), [Lobe::Sheen, Lobe::Specular]);
        assert!(!set.contains(Lobe::ClearCoat) && !set.is_empty() && Lobes::NONE.is_empty());
        assert_eq!(Lobes::NONE.with(Lobe::Sheen).union(Lobes::NONE.with(Lobe::Specular)), set);
    }
}
