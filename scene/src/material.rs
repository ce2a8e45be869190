//! Metallic-roughness materials, as in glTF 2.0.

mod lobes;
mod stencil;

use glam::{Vec3, Vec4};

use super::id::Id;
use super::texture::{TextureRole, TextureSlot};

pub use lobes::{
    Anisotropy, ClearCoat, DiffuseTransmission, Iridescence, Lobe, Lobes, Sheen, Specular, Subsurface, Transmission,
    Volume,
};
pub use stencil::{Stencil, StencilCompare, StencilFace, StencilOp};

/// Id of a material of a scene.
pub type MaterialId = Id<Material>;

/// Alpha mode of a material (glTF 2.0, section 3.9.4).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Alpha test: nothing is drawn below `cutoff`; otherwise the surface is opaque.
    Mask {
        /// Minimum alpha that is drawn; above 1 nothing is.
        cutoff: f32,
    },
    /// Alpha blending over the background (Porter–Duff over, straight alpha).
    Blend,
}

/// Order of the triangles of a blended object (Filament's `TransparencyMode`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TransparencyMode {
    /// Order of the mesh (`DEFAULT`).
    #[default]
    Default,
    /// Only the nearest surfaces: depth is drawn first, then the surfaces at that depth (`TWO_PASSES_ONE_SIDE`). They
    /// hide objects that are drawn later and lie behind.
    TwoPassesOneSide,
    /// Back faces first, then front faces, independent of [`Material::double_sided`] (`TWO_PASSES_TWO_SIDES`).
    TwoPassesTwoSides,
}

impl TransparencyMode {
    /// All modes with their names in files.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("default", Self::Default),
        ("two-passes-one-side", Self::TwoPassesOneSide),
        ("two-passes-two-sides", Self::TwoPassesTwoSides),
    ];
}

/// Unit of an emission.
///
/// glTF defines the unit as nits "where a physical light unit is needed" (section 3.9.3). A factor of at most 1 nit
/// would be black under any daylight exposure, which is not what files intend.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EmissiveUnit {
    /// Brightness on the display, independent of exposure. Used for files without KHR_materials_emissive_strength.
    #[default]
    Display,
    /// Luminance in nits, exposed like reflected light.
    Nits,
}

/// Metallic-roughness material. Factors multiply the values of their textures; a missing texture counts as 1.
///
/// Colors are linear Rec.709. The base color of a metal is its reflectance at normal incidence, that of a dielectric
/// its diffuse albedo.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name, for messages; may be empty.
    pub name: String,
    /// Base color in 0…1 and alpha (glTF `baseColorFactor`).
    pub base_color: Vec4,
    /// Metalness: 0 for a dielectric, 1 for a metal (glTF `metallicFactor`).
    pub metallic: f32,
    /// Perceptual roughness 0…1; the GGX parameter α is its square.
    pub roughness: f32,
    /// Emission per channel, 0 or more: `emissiveFactor` times KHR_materials_emissive_strength.
    pub emissive: Vec3,
    /// Unit of `emissive`.
    pub emissive_unit: EmissiveUnit,
    /// Index of refraction of the dielectric part (KHR_materials_ior), 1 or more. 0 stands for infinity, a reflectance
    /// of 1.
    pub ior: f32,
    /// Dispersion of the volume (KHR_materials_dispersion): 20 divided by the Abbe number, 0 or more. `None` refracts
    /// all wavelengths alike. Has no effect without a transmitting volume.
    pub dispersion: Option<f32>,
    /// Scale of the x and y components of the tangent-space normal.
    pub normal_scale: f32,
    /// Strength of the occlusion texture, from 0 (no effect) to 1.
    pub occlusion_strength: f32,
    /// Alpha mode: opaque, alpha-tested or blended.
    pub alpha: AlphaMode,
    /// Order of the triangles of an object, if it is blended and blended surfaces are sorted.
    pub transparency: TransparencyMode,
    /// True if back faces are drawn too, with flipped normals.
    pub double_sided: bool,
    /// True if the base color is shown without shading (KHR_materials_unlit). Lines and points add the emission (glTF
    /// 2.0, section 3.9.7).
    pub unlit: bool,
    /// Texture of base color (RGB) and alpha (A); role `Color`.
    pub base_color_texture: Option<TextureSlot>,
    /// Texture of roughness (G) and metallic (B); role `Linear`.
    pub metallic_roughness_texture: Option<TextureSlot>,
    /// Texture of tangent-space normals; role `Normal`.
    pub normal_texture: Option<TextureSlot>,
    /// Texture of ambient occlusion for indirect light (R); role `Linear`.
    pub occlusion_texture: Option<TextureSlot>,
    /// Texture of the emission (RGB); role `Color`.
    pub emissive_texture: Option<TextureSlot>,
    /// Clear coat: a second specular layer over the surface.
    pub clear_coat: Option<ClearCoat>,
    /// Sheen: light scattered back by fibers, as in cloth.
    pub sheen: Option<Sheen>,
    /// Anisotropy: highlights stretched along a direction, as on brushed metal.
    pub anisotropy: Option<Anisotropy>,
    /// Transmission: light that passes through the surface, as through glass.
    pub transmission: Option<Transmission>,
    /// Strength and tint of the dielectric specular reflection.
    pub specular: Option<Specular>,
    /// Iridescence: interference in a thin film over the base.
    pub iridescence: Option<Iridescence>,
    /// Diffuse transmission: light scattered through the surface, as in leaves.
    pub diffuse_transmission: Option<DiffuseTransmission>,
    /// Subsurface scattering, as in Filament's shading model `subsurface`.
    pub subsurface: Option<Subsurface>,
    /// Color of light scattered within cloth, linear Rec.709, 0…1; diffuse light wraps around the terminator with this
    /// tint. Filament: `subsurfaceColor` of the shading model `cloth`, whose specular lobe is the sheen.
    pub cloth_subsurface: Option<Vec3>,
    /// Makes the surface a shadow catcher: it shows only shadows of the sun. The value is their strength from 0 to 1,
    /// multiplied by alpha. Requires an unlit, blended surface. Filament: `shadowMultiplier` and `shadowStrength`.
    pub shadow_catcher: Option<f32>,
    /// Stencil test and operations. A scene without any is drawn without a stencil buffer.
    pub stencil: Option<Box<Stencil>>,
}

/// Number of texture slots of a material.
pub const SLOT_COUNT: usize = 19;

/// Role of each texture slot, in the order of [`Material::slots`].
pub const SLOT_ROLES: [TextureRole; SLOT_COUNT] = {
    use TextureRole::{Color, Linear, Normal};
    [
        Color, Linear, Normal, Linear, Color, // base
        Linear, Linear, Normal, // clear coat
        Color, Linear, // sheen
        Linear, // anisotropy
        Linear, Linear, // transmission, volume
        Linear, Color, // specular
        Linear, Linear, // iridescence
        Linear, Color, // diffuse transmission
    ]
};

impl Default for Material {
    /// Returns glTF's default material: white, fully metallic and rough.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::ONE,
            metallic: 1.0,
            roughness: 1.0,
            emissive: Vec3::ZERO,
            emissive_unit: EmissiveUnit::Display,
            ior: 1.5,
            dispersion: None,
            normal_scale: 1.0,
            occlusion_strength: 1.0,
            alpha: AlphaMode::Opaque,
            transparency: TransparencyMode::Default,
            double_sided: false,
            unlit: false,
            base_color_texture: None,
            metallic_roughness_texture: None,
            normal_texture: None,
            occlusion_texture: None,
            emissive_texture: None,
            clear_coat: None,
            sheen: None,
            anisotropy: None,
            transmission: None,
            specular: None,
            iridescence: None,
            diffuse_transmission: None,
            subsurface: None,
            cloth_subsurface: None,
            shadow_catcher: None,
            stencil: None,
        }
    }
}

impl Material {
    /// Returns a dielectric with a diffuse albedo and a perceptual roughness.
    #[must_use]
    pub fn dielectric(name: &str, albedo: Vec3, roughness: f32) -> Self {
        Self { name: name.into(), base_color: albedo.extend(1.0), metallic: 0.0, roughness, ..Self::default() }
    }

    /// Returns a metal with a reflectance at normal incidence and a perceptual roughness.
    #[must_use]
    pub fn metal(name: &str, f0: Vec3, roughness: f32) -> Self {
        Self { metallic: 1.0, ..Self::dielectric(name, f0, roughness) }
    }

    /// Returns every texture slot: first those of the base, then those of each lobe.
    #[must_use]
    pub fn slots(&self) -> [Option<TextureSlot>; SLOT_COUNT] {
        let Self { clear_coat, sheen, anisotropy, transmission, specular, iridescence, diffuse_transmission, .. } =
            self;
        [
            self.base_color_texture,
            self.metallic_roughness_texture,
            self.normal_texture,
            self.occlusion_texture,
            self.emissive_texture,
            clear_coat.and_then(|c| c.texture),
            clear_coat.and_then(|c| c.roughness_texture),
            clear_coat.and_then(|c| c.normal_texture),
            sheen.and_then(|s| s.color_texture),
            sheen.and_then(|s| s.roughness_texture),
            anisotropy.and_then(|a| a.texture),
            transmission.and_then(|t| t.texture),
            self.volume().and_then(|v| v.thickness_texture),
            specular.and_then(|s| s.texture),
            specular.and_then(|s| s.color_texture),
            iridescence.and_then(|i| i.texture),
            iridescence.and_then(|i| i.thickness_texture),
            diffuse_transmission.and_then(|d| d.texture),
            diffuse_transmission.and_then(|d| d.color_texture),
        ]
    }

    /// Returns the volume behind the surface, if light passes into it.
    #[must_use]
    pub fn volume(&self) -> Option<Volume> {
        let scattered = self.diffuse_transmission.and_then(|d| d.volume);
        self.transmission.and_then(|t| t.volume).or(scattered)
    }

    /// Returns the lobes that shading must evaluate; none for an unlit material.
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        let has = |lobe: &Lobe| match lobe {
            Lobe::ClearCoat => self.clear_coat.is_some(),
            Lobe::Sheen => self.sheen.is_some(),
            Lobe::Anisotropy => self.anisotropy.is_some(),
            Lobe::Transmission => self.transmission.is_some(),
            Lobe::Specular => self.specular.is_some(),
            Lobe::Iridescence => self.iridescence.is_some(),
            Lobe::Dispersion => self.dispersion.is_some() && self.transmission.is_some_and(|t| t.volume.is_some()),
            Lobe::DiffuseTransmission => self.diffuse_transmission.is_some(),
            Lobe::Subsurface => self.subsurface.is_some(),
            Lobe::ClothSubsurface => self.cloth_subsurface.is_some(),
        };
        Lobe::ALL.into_iter().filter(|lobe| !self.unlit && has(lobe)).collect()
    }

    /// Returns true if the material is an effective shadow catcher.
    #[must_use]
    pub fn catches_shadows(&self) -> bool {
        self.shadow_catcher.is_some() && self.unlit && self.alpha == AlphaMode::Blend
    }

    /// Returns the texture coordinate set for tangents: that of the normal map, otherwise of the clear coat's normal
    /// map, otherwise of anisotropy. `None` if tangents are not needed.
    #[must_use]
    pub fn tangent_uv_set(&self) -> Option<u32> {
        let coat = self.clear_coat.and_then(|c| c.normal_texture);
        let normal = self.normal_texture.or(coat).map(|slot| slot.uv_set);
        normal.or_else(|| self.anisotropy.map(|a| a.texture.map_or(0, |slot| slot.uv_set)))
    }

    /// Returns the reflectance of the dielectric part at normal incidence: ((n − 1) / (n + 1))², 0.04 for 1.5.
    #[must_use]
    pub fn dielectric_f0(&self) -> f32 {
        if self.ior == 0.0 {
            return 1.0;
        }
        let ratio = (self.ior - 1.0) / (self.ior + 1.0);
        ratio * ratio
    }
}
