//! Metal-rough materials, as glTF 2.0 states them.

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

/// A material of a scene.
pub type MaterialId = Id<Material>;

/// What alpha means for a material (glTF 2.0, section 3.9.4).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AlphaMode {
    /// Alpha is ignored.
    #[default]
    Opaque,
    /// Below `cutoff` nothing is drawn, otherwise the surface is opaque.
    Mask {
        /// The least alpha that is drawn; above 1 nothing is.
        cutoff: f32,
    },
    /// The surface covers what is behind it by alpha (Porter–Duff over, straight alpha).
    Blend,
}

/// How triangles of one blended object are put in order (Filament's `TransparencyMode`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TransparencyMode {
    /// In the order of the mesh (`DEFAULT`).
    #[default]
    Default,
    /// The nearest surfaces alone: depth is drawn first, then what has that depth (`TWO_PASSES_ONE_SIDE`). Objects drawn
    /// later are hidden behind it.
    TwoPassesOneSide,
    /// Back faces first, then front faces, whatever [`Material::double_sided`] says (`TWO_PASSES_TWO_SIDES`).
    TwoPassesTwoSides,
}

impl TransparencyMode {
    /// Modes by their names in files.
    pub const NAMES: [(&'static str, Self); 3] = [
        ("default", Self::Default),
        ("two-passes-one-side", Self::TwoPassesOneSide),
        ("two-passes-two-sides", Self::TwoPassesTwoSides),
    ];
}

/// What the numbers of an emission mean.
///
/// glTF calls both nits "where a physical light unit is needed" (section 3.9.3), but a factor of at
/// most 1 nit would be black under any daylight exposure, and is not what files mean by it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum EmissiveUnit {
    /// Brightness on the display: not exposed. Files without KHR_materials_emissive_strength.
    #[default]
    Display,
    /// Luminance in nits: exposed like reflected light.
    Nits,
}

/// A metal-rough surface. Factors multiply what their texture says; a missing texture reads as 1.
///
/// Colors are linear Rec.709. A metal's base color is its reflectance at normal incidence, a
/// dielectric's is its diffuse albedo.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name, for messages; may be empty.
    pub name: String,
    /// Base color in 0…1 and alpha (glTF `baseColorFactor`).
    pub base_color: Vec4,
    /// Share of the surface that is metal: 0 a dielectric, 1 a metal (glTF `metallicFactor`).
    pub metallic: f32,
    /// Perceptual roughness 0…1; the GGX parameter is its square.
    pub roughness: f32,
    /// Emission per channel: `emissiveFactor` times KHR_materials_emissive_strength, 0 or more.
    pub emissive: Vec3,
    /// The unit of `emissive`.
    pub emissive_unit: EmissiveUnit,
    /// Index of refraction of the dielectric part (KHR_materials_ior): 1 or more; 0 stands for
    /// infinity, a reflectance of 1.
    pub ior: f32,
    /// Dispersion of the volume (KHR_materials_dispersion): 20 over the Abbe number, 0 or more; `None` where all colors
    /// refract alike. Without a volume that transmits it has no effect.
    pub dispersion: Option<f32>,
    /// Scales x and y of the tangent-space normal.
    pub normal_scale: f32,
    /// Strength of the occlusion texture, 0 (no effect)…1.
    pub occlusion_strength: f32,
    /// Whether alpha is ignored, tested or blended.
    pub alpha: AlphaMode,
    /// How triangles of an object are put in order, where it blends and blended surfaces are sorted.
    pub transparency: TransparencyMode,
    /// Draw back faces too, with their normals turned towards the viewer.
    pub double_sided: bool,
    /// The base color is shown without shading (KHR_materials_unlit). Lines and points add the emission (glTF 2.0, section 3.9.7).
    pub unlit: bool,
    /// Texture of base color (RGB) and alpha (A); role `Color`.
    pub base_color_texture: Option<TextureSlot>,
    /// Texture of roughness (G) and metallic (B); role `Linear`.
    pub metallic_roughness_texture: Option<TextureSlot>,
    /// Texture of the tangent-space normal; role `Normal`.
    pub normal_texture: Option<TextureSlot>,
    /// Texture of the occlusion of indirect light (R); role `Linear`.
    pub occlusion_texture: Option<TextureSlot>,
    /// Texture of the emission (RGB); role `Color`.
    pub emissive_texture: Option<TextureSlot>,
    /// A clear layer over the surface with a specular reflection of its own.
    pub clear_coat: Option<ClearCoat>,
    /// Light scattered back by fibers that stand up from the surface, as cloth does.
    pub sheen: Option<Sheen>,
    /// Highlights stretched along a direction of the surface, as on brushed metal.
    pub anisotropy: Option<Anisotropy>,
    /// Light that passes through the surface, as through glass.
    pub transmission: Option<Transmission>,
    /// Strength and tint of the dielectric part's specular reflection.
    pub specular: Option<Specular>,
    /// A thin film over the base, in which light interferes.
    pub iridescence: Option<Iridescence>,
    /// Light that is scattered through the surface, as through a leaf.
    pub diffuse_transmission: Option<DiffuseTransmission>,
    /// Light that is scattered below the surface, Filament's shading model `subsurface`.
    pub subsurface: Option<Subsurface>,
    /// Color of light that is scattered in cloth, linear Rec.709, 0…1: the diffuse light is wrapped about the terminator and
    /// tinted there. Filament: `subsurfaceColor` of the shading model `cloth`, whose specular lobe is the sheen.
    pub cloth_subsurface: Option<Vec3>,
    /// Makes the surface a shadow catcher: it is seen where the sun is in shadow alone, by this strength from 0 to 1, times its
    /// alpha. It takes effect where the surface is unlit and blended. Filament: `shadowMultiplier` and `shadowStrength`.
    pub shadow_catcher: Option<f32>,
    /// Stencil test and operations; a scene in which no material has any is drawn without a stencil buffer.
    pub stencil: Option<Box<Stencil>>,
}

/// How many textures a material can have.
pub const SLOT_COUNT: usize = 19;

/// The role of each texture slot, in the order of [`Material::slots`].
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
    /// glTF's default material: white, fully metallic and rough.
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
    /// A dielectric of this diffuse albedo and perceptual roughness.
    #[must_use]
    pub fn dielectric(name: &str, albedo: Vec3, roughness: f32) -> Self {
        Self { name: name.into(), base_color: albedo.extend(1.0), metallic: 0.0, roughness, ..Self::default() }
    }

    /// A metal of this reflectance at normal incidence and perceptual roughness.
    #[must_use]
    pub fn metal(name: &str, f0: Vec3, roughness: f32) -> Self {
        Self { metallic: 1.0, ..Self::dielectric(name, f0, roughness) }
    }

    /// Every texture slot: those of the base, then those of each lobe.
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

    /// The body behind the surface, if light passes into it.
    #[must_use]
    pub fn volume(&self) -> Option<Volume> {
        let scattered = self.diffuse_transmission.and_then(|d| d.volume);
        self.transmission.and_then(|t| t.volume).or(scattered)
    }

    /// The lobes that shading has to evaluate; none where the base color is shown as it is.
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

    /// Returns true for a shadow catcher that takes effect.
    #[must_use]
    pub fn catches_shadows(&self) -> bool {
        self.shadow_catcher.is_some() && self.unlit && self.alpha == AlphaMode::Blend
    }

    /// The texture coordinates that tangents must follow: those of the normal map, else of the coat's, else of the
    /// anisotropy, whose direction counts from the tangent. `None` where nothing asks for tangents.
    #[must_use]
    pub fn tangent_uv_set(&self) -> Option<u32> {
        let coat = self.clear_coat.and_then(|c| c.normal_texture);
        let normal = self.normal_texture.or(coat).map(|slot| slot.uv_set);
        normal.or_else(|| self.anisotropy.map(|a| a.texture.map_or(0, |slot| slot.uv_set)))
    }

    /// Reflectance of the dielectric part at normal incidence: ((n − 1) / (n + 1))², 0.04 for 1.5.
    #[must_use]
    pub fn dielectric_f0(&self) -> f32 {
        if self.ior == 0.0 {
            return 1.0;
        }
        let ratio = (self.ior - 1.0) / (self.ior + 1.0);
        ratio * ratio
    }
}
