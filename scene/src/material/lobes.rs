//! The lobes that a surface may have beside the metal-rough base, in glTF's terms.
//!
//! A material holds a lobe only where it shows: importers leave out what a zero factor switches off, so the set of lobes
//! in a scene is the set of effects that it calls for.

use glam::Vec3;

use crate::texture::TextureSlot;

/// A thin clear layer over the surface (KHR_materials_clearcoat), as varnish on wood or lacquer on a car: a second
/// specular lobe over everything else.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ClearCoat {
    /// How much of the surface is coated, 0…1.
    pub factor: f32,
    /// Perceptual roughness of the coat, 0…1.
    pub roughness: f32,
    /// Scales x and y of the coat's tangent-space normal.
    pub normal_scale: f32,
    /// Texture of the factor (R); role `Linear`.
    pub texture: Option<TextureSlot>,
    /// Texture of the roughness (G); role `Linear`.
    pub roughness_texture: Option<TextureSlot>,
    /// Texture of the coat's tangent-space normal; without it the coat has the mesh's normals. Role `Normal`.
    pub normal_texture: Option<TextureSlot>,
    /// Keeps the base's reflectance at normal incidence, as in air. By default, the base meets the coat's index of 1.5, which
    /// lowers it. Filament: material property `clearCoatIorChange` set to false.
    pub keeps_base_f0: bool,
}

/// Fibers that stand up from the surface (KHR_materials_sheen): brightest at the silhouette.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sheen {
    /// Reflectance of the fibers, linear Rec.709, 0…1.
    pub color: Vec3,
    /// Perceptual roughness 0…1: how far the fibers spread.
    pub roughness: f32,
    /// Texture of the color (RGB); role `Color`.
    pub color_texture: Option<TextureSlot>,
    /// Texture of the roughness (A); role `Linear`.
    pub roughness_texture: Option<TextureSlot>,
}

/// Roughness that differs by direction (KHR_materials_anisotropy), as on brushed metal: highlights are stretched along a
/// direction of the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Anisotropy {
    /// How far the roughness along the direction goes towards 1: 0 not at all, 1 all the way.
    pub strength: f32,
    /// From the tangent to the direction, counter-clockwise in the tangent plane, in radians.
    pub rotation_rad: f32,
    /// Texture of the direction (RG, decoded to −1…1) and the strength (B); role `Linear`.
    pub texture: Option<TextureSlot>,
}

/// Light that passes through the surface (KHR_materials_transmission) into what lies behind it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Transmission {
    /// How much of the light that enters is transmitted and not scattered diffusely, 0…1.
    pub factor: f32,
    /// Texture of the factor (R); role `Linear`.
    pub texture: Option<TextureSlot>,
    /// The body behind the surface; `None` is a thin wall, which does not refract.
    pub volume: Option<Volume>,
}

/// The inside of a transmitting body (KHR_materials_volume).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volume {
    /// Depth of the body under the surface in units of the mesh, above 0.
    pub thickness: f32,
    /// Texture of the thickness (G); role `Linear`.
    pub thickness_texture: Option<TextureSlot>,
    /// What white light becomes over `attenuation_distance_m`, linear Rec.709, 0…1.
    pub attenuation_color: Vec3,
    /// In meters of the world, above 0; infinity absorbs nothing.
    pub attenuation_distance_m: f32,
}

/// A thin film over the base (KHR_materials_iridescence), as on soap bubbles or oil: light reflected at its two sides
/// interferes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iridescence {
    /// Share of the surface under the film, 0…1.
    pub factor: f32,
    /// Texture of the factor (R); role `Linear`.
    pub texture: Option<TextureSlot>,
    /// Index of refraction of the film, 1 or more.
    pub ior: f32,
    /// Thickness of the film in nanometers where its texture is 0.
    pub min_thickness_nm: f32,
    /// Thickness of the film in nanometers where its texture is 1, and without a texture.
    pub max_thickness_nm: f32,
    /// Texture of the thickness (G); role `Linear`.
    pub thickness_texture: Option<TextureSlot>,
}

/// Light that is scattered through the surface (KHR_materials_diffuse_transmission), as through leaves, paper or wax.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DiffuseTransmission {
    /// Share of the scattered light that leaves on the other side, 0…1.
    pub factor: f32,
    /// Texture of the factor (A); role `Linear`.
    pub texture: Option<TextureSlot>,
    /// Albedo of the light that leaves on the other side, linear Rec.709, 0…1.
    pub color: Vec3,
    /// Texture of the color (RGB); role `Color`.
    pub color_texture: Option<TextureSlot>,
    /// Body behind the surface, which absorbs light on its way; `None` is a thin sheet.
    pub volume: Option<Volume>,
}

/// Strength and tint of a dielectric's reflection (KHR_materials_specular); metals have their base color.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Specular {
    /// Factor on the whole reflection, 0…1.
    pub factor: f32,
    /// Factor on reflectance at normal incidence, linear Rec.709, 0 or more; the product is held at 1.
    pub color: Vec3,
    /// Texture of the factor (A); role `Linear`.
    pub texture: Option<TextureSlot>,
    /// Texture of the color (RGB); role `Color`.
    pub color_texture: Option<TextureSlot>,
}

/// Light scattered below the surface, as in skin, wax or leaves. It is Filament's shading model `subsurface`: an approximation
/// in the style of films, which conserves no energy. In glTF files it is `{"subsurface": {...}}` of the material's extras.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Subsurface {
    /// Color of the scattered light, linear Rec.709, 0…1. Filament: `subsurfaceColor`.
    pub color: Vec3,
    /// Exponent of the lobe toward lights behind the surface, 0 to [`Subsurface::MAX_POWER`]; larger values make it smaller.
    /// Filament: `subsurfacePower`.
    pub power: f32,
    /// Thickness, from 0 (light passes unhindered) to 1 (none passes); without a unit. Filament: `thickness`.
    pub thickness: f32,
}

impl Subsurface {
    /// Largest exponent.
    pub const MAX_POWER: f32 = 10_000.0;
}

impl Default for Subsurface {
    /// Filament's defaults: white, power 12.234, thickness 0.5.
    fn default() -> Self {
        Self { color: Vec3::ONE, power: 12.234, thickness: 0.5 }
    }
}

impl Default for Iridescence {
    /// The defaults of the extension, with the film everywhere: index 1.3, 100 to 400 nm.
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
    /// A thin white sheet that scatters all light through.
    fn default() -> Self {
        Self { factor: 1.0, texture: None, color: Vec3::ONE, color_texture: None, volume: None }
    }
}

impl Default for Volume {
    /// One unit of the mesh thick, without absorption.
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
    /// Factor and color of 1, which change nothing.
    fn default() -> Self {
        Self { factor: 1.0, color: Vec3::ONE, texture: None, color_texture: None }
    }
}

impl Volume {
    /// Absorption coefficient of each channel in 1/m (Beer and Lambert): −ln(color) / distance.
    ///
    /// A black channel counts as a millionth, so that the result is finite.
    #[must_use]
    pub fn absorption_per_m(&self) -> Vec3 {
        let optical_depth = -self.attenuation_color.clamp(Vec3::splat(1e-6), Vec3::ONE).map(f32::ln);
        // No distance is no information, not absorption without bounds.
        optical_depth / self.attenuation_distance_m.max(1e-6)
    }
}

/// A lobe that a material may have beside the metal-rough base.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Lobe {
    /// A clear layer over the surface: [`ClearCoat`].
    ClearCoat,
    /// Light scattered back by fibers: [`Sheen`].
    Sheen,
    /// Highlights stretched along a direction: [`Anisotropy`].
    Anisotropy,
    /// Light that passes through: [`Transmission`].
    Transmission,
    /// Strength and tint of the dielectric reflection: [`Specular`].
    Specular,
    /// A thin film over the base: [`Iridescence`].
    Iridescence,
    /// Refraction that differs by color ([`Material::dispersion`](super::Material::dispersion)).
    Dispersion,
    /// Light that is scattered through: [`DiffuseTransmission`].
    DiffuseTransmission,
    /// Light that is scattered below the surface: [`Subsurface`].
    Subsurface,
    /// Light that is scattered in cloth ([`Material::cloth_subsurface`](super::Material::cloth_subsurface)).
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

/// A set of lobes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Lobes(u16);

impl Lobes {
    /// The metal-rough base alone.
    pub const NONE: Self = Self(0);

    /// The set with `lobe` added.
    #[must_use]
    pub const fn with(self, lobe: Lobe) -> Self {
        Self(self.0 | 1 << lobe as u8)
    }

    /// The members of either set.
    #[must_use]
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether there is no lobe beside the base.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Whether `lobe` is in the set.
    pub const fn contains(self, lobe: Lobe) -> bool {
        self.0 & 1 << lobe as u8 != 0
    }

    /// The members, in declaration order.
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
