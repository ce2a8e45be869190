//! Mirror of `wgsl/interface/material_uniforms.wgsl` and of the traits in `wgsl/interface/material.wgsl`. The uniforms
//! of lobes that a material lacks hold their defaults and are not read.

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3, Vec4};

/// Maximum number of textures of a material. Texture slot `i` is bit `i` of the constant `MATERIAL_TRAITS`.
pub const MATERIAL_SLOTS: u32 = 19;
/// Bit number in `MATERIAL_TRAITS` for materials that emit light. Lower bits are texture slots.
pub const TRAIT_EMITS: u32 = MATERIAL_SLOTS;
/// Bit number in `MATERIAL_TRAITS` for double-sided materials, whose back faces are shaded with reversed normals.
pub const TRAIT_DOUBLE_SIDED: u32 = MATERIAL_SLOTS + 1;
/// Bit number in `MATERIAL_TRAITS` for unlit materials (KHR_materials_unlit).
pub const TRAIT_UNLIT: u32 = MATERIAL_SLOTS + 2;
/// Bit number in `MATERIAL_TRAITS` for materials whose textures all use texture coordinate set 0 without a transform.
pub const TRAIT_PLAIN_UV: u32 = MATERIAL_SLOTS + 3;
/// Bit number in `MATERIAL_TRAITS` for materials whose occlusion is the red channel of the metallic-roughness texture,
/// with the same texture coordinates.
pub const TRAIT_PACKED_OCCLUSION: u32 = MATERIAL_SLOTS + 4;
/// Bit number in `MATERIAL_TRAITS` for lines and points, which have no geometric normal. Set by the mesh, not by the
/// material.
pub const TRAIT_NO_AREA: u32 = MATERIAL_SLOTS + 5;
/// Bit number in `MATERIAL_TRAITS` for materials whose base keeps its reflectance in air under the clear coat.
pub const TRAIT_COAT_KEEPS_F0: u32 = MATERIAL_SLOTS + 6;
/// Bit number in `MATERIAL_TRAITS` for shadow catchers, which are visible only where the sun is in shadow.
pub const TRAIT_SHADOW_CATCHER: u32 = MATERIAL_SLOTS + 7;

/// Mapping from the mesh's texture coordinates to a texture (KHR_texture_transform). Not read without a texture.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct TextureMap {
    /// First column of the 2×2 matrix rotation · scale.
    pub x_axis: Vec2,
    /// Second column of the 2×2 matrix rotation · scale.
    pub y_axis: Vec2,
    /// Translation in texture coordinates, applied last.
    pub offset: Vec2,
    /// Number of the mesh's texture coordinate set, 0 or 1.
    pub uv_set: u32,
    /// Padding to 8 bytes; zero.
    pub _pad: u32,
}

impl Default for TextureMap {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl TextureMap {
    /// Texture coordinate set 0 without a transform.
    pub const IDENTITY: Self = Self { x_axis: Vec2::X, y_axis: Vec2::Y, offset: Vec2::ZERO, uv_set: 0, _pad: 0 };

    /// Creates the mapping of KHR_texture_transform, offset · rotation · scale. `rotation_rad` is counter-clockwise in
    /// texture space, whose v axis points down.
    pub fn new(uv_set: u32, offset: Vec2, rotation_rad: f32, scale: Vec2) -> Self {
        let (sin, cos) = rotation_rad.sin_cos();
        Self { x_axis: Vec2::new(cos, -sin) * scale.x, y_axis: Vec2::new(sin, cos) * scale.y, offset, uv_set, _pad: 0 }
    }
}

/// Factors of a glTF metallic-roughness material and its lobes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct MaterialUniforms {
    /// Base color factor, linear Rec.709, with straight (not premultiplied) alpha.
    pub base_color: Vec4,
    /// Emitted radiance, linear Rec.709, including the emissive strength.
    pub emissive: Vec3,
    /// 1: `emissive` is in nits and is multiplied by the exposure. 0: `emissive` is a display value.
    pub emissive_exposure_weight: f32,
    /// Metalness, from 0 for dielectrics to 1 for metals.
    pub metallic: f32,
    /// Perceptual roughness, 0…1.
    pub roughness: f32,
    /// Factor on x and y of the normal map.
    pub normal_scale: f32,
    /// Strength of the occlusion texture, 0…1.
    pub occlusion_strength: f32,
    /// Alpha threshold of mode MASK: fragments with lower alpha are discarded.
    pub alpha_cutoff: f32,
    /// Reflectance of the dielectric part at normal incidence; 0.04 for an index of refraction of 1.5.
    pub dielectric_f0: f32,
    /// Strength of the shadow on a shadow catcher, 0…1.
    pub catcher_strength: f32,
    /// Padding to 16 bytes; zero.
    pub _pad: u32,
    /// Texture of the base color.
    pub base_color_map: TextureMap,
    /// Texture of roughness and metalness.
    pub metallic_roughness_map: TextureMap,
    /// Texture of the tangent-space normal.
    pub normal_map: TextureMap,
    /// Texture of the ambient occlusion.
    pub occlusion_map: TextureMap,
    /// Texture of the emission.
    pub emissive_map: TextureMap,
    /// Clear coat; read with the feature `CLEAR_COAT`.
    pub clear_coat: ClearCoatUniforms,
    /// Sheen; read with the feature `SHEEN`.
    pub sheen: SheenUniforms,
    /// Anisotropy; read with the feature `ANISOTROPY`.
    pub anisotropy: AnisotropyUniforms,
    /// Transmission and volume; read with the feature `TRANSMISSION`. The volume is also read with
    /// `DIFFUSE_TRANSMISSION`.
    pub transmission: TransmissionUniforms,
    /// Dielectric specular reflection; read with the feature `SPECULAR`.
    pub specular: SpecularUniforms,
    /// Thin film; read with the feature `IRIDESCENCE`.
    pub iridescence: IridescenceUniforms,
    /// Diffuse transmission; read with the feature `DIFFUSE_TRANSMISSION`.
    pub diffuse_transmission: DiffuseTransmissionUniforms,
    /// Subsurface scattering; read with the features `SUBSURFACE` and `CLOTH_SUBSURFACE`.
    pub subsurface: SubsurfaceUniforms,
}

/// Subsurface scattering (Filament's shading models `subsurface` and `cloth`).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SubsurfaceUniforms {
    /// Color of the scattered light, linear Rec.709, 0…1.
    pub color: Vec3,
    /// Exponent of the lobe toward lights behind the surface, 0 or more.
    pub power: f32,
    /// Subsurface color of cloth, linear Rec.709, 0…1.
    pub cloth_color: Vec3,
    /// Thickness, from 0 for thin to 1 for opaque.
    pub thickness: f32,
}

/// Clear coat, a dielectric layer over the other lobes (KHR_materials_clearcoat).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ClearCoatUniforms {
    /// Coverage of the surface by the coat, 0…1.
    pub factor: f32,
    /// Perceptual roughness of the coat, 0…1.
    pub roughness: f32,
    /// Factor on x and y of the coat's normal map.
    pub normal_scale: f32,
    /// Padding to 16 bytes; zero.
    pub _pad: u32,
    /// Texture of the factor.
    pub map: TextureMap,
    /// Texture of the roughness.
    pub roughness_map: TextureMap,
    /// Texture of the coat's tangent-space normal.
    pub normal_map: TextureMap,
}

/// Sheen, a cloth lobe over the base (KHR_materials_sheen).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SheenUniforms {
    /// Reflectance of the lobe, linear Rec.709.
    pub color: Vec3,
    /// Perceptual roughness, 0…1.
    pub roughness: f32,
    /// Texture of the color.
    pub color_map: TextureMap,
    /// Texture of the roughness.
    pub roughness_map: TextureMap,
}

/// Anisotropy of the base lobe (KHR_materials_anisotropy).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct AnisotropyUniforms {
    /// Cosine and sine of the angle from the tangent to the direction of anisotropy.
    pub rotation: Vec2,
    /// Strength of the anisotropy, 0…1.
    pub strength: f32,
    /// Padding to 16 bytes; zero.
    pub _pad: u32,
    /// Texture of direction and strength.
    pub map: TextureMap,
}

/// Transmission through the surface, the volume under it and its dispersion (KHR_materials_transmission,
/// KHR_materials_volume, KHR_materials_dispersion).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TransmissionUniforms {
    /// Transmission: the share of the light entering the surface that passes through it, 0…1.
    pub factor: f32,
    /// Index of refraction, 1 or more.
    pub ior: f32,
    /// Thickness of the volume in units of the mesh; 0 is a thin wall.
    pub thickness: f32,
    /// Dispersion: 20 over the Abbe number, 0 or more.
    pub dispersion: f32,
    /// Absorption coefficient in 1/m, by channel of linear Rec.709.
    pub absorption: Vec3,
    /// Padding to 16 bytes; zero.
    pub _pad: u32,
    /// Texture of the factor.
    pub map: TextureMap,
    /// Texture of the thickness.
    pub thickness_map: TextureMap,
}

/// Strength and tint of the dielectric specular reflection (KHR_materials_specular).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SpecularUniforms {
    /// Factor on the dielectric reflectance at normal incidence, linear Rec.709.
    pub color: Vec3,
    /// Factor on the dielectric reflectance at all angles, 0…1.
    pub factor: f32,
    /// Texture of the factor.
    pub map: TextureMap,
    /// Texture of the color.
    pub color_map: TextureMap,
}

/// Thin film over the base (KHR_materials_iridescence).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct IridescenceUniforms {
    /// Coverage of the surface by the film, 0…1.
    pub factor: f32,
    /// Index of refraction of the film, 1 or more.
    pub ior: f32,
    /// Film thickness in nm at texture value 0.
    pub min_thickness_nm: f32,
    /// Film thickness in nm at texture value 1, or without a texture.
    pub max_thickness_nm: f32,
    /// Texture of the factor.
    pub map: TextureMap,
    /// Texture of the thickness.
    pub thickness_map: TextureMap,
}

/// Diffuse transmission (KHR_materials_diffuse_transmission).
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DiffuseTransmissionUniforms {
    /// Albedo of the light that leaves through the back, linear Rec.709.
    pub color: Vec3,
    /// Share of the scattered light that leaves through the back, 0…1.
    pub factor: f32,
    /// Texture of the factor.
    pub map: TextureMap,
    /// Texture of the color.
    pub color_map: TextureMap,
}

impl Default for MaterialUniforms {
    /// Returns the defaults of glTF 2.0, except `metallic`, which is 0. The glTF default of 1 turns materials without a
    /// texture into metals, and importers always set it.
    fn default() -> Self {
        Self {
            base_color: Vec4::ONE,
            emissive: Vec3::ZERO,
            emissive_exposure_weight: 0.0,
            metallic: 0.0,
            roughness: 1.0,
            normal_scale: 1.0,
            occlusion_strength: 1.0,
            alpha_cutoff: 0.5,
            dielectric_f0: 0.04,
            catcher_strength: 1.0,
            _pad: 0,
            base_color_map: TextureMap::IDENTITY,
            metallic_roughness_map: TextureMap::IDENTITY,
            normal_map: TextureMap::IDENTITY,
            occlusion_map: TextureMap::IDENTITY,
            emissive_map: TextureMap::IDENTITY,
            clear_coat: ClearCoatUniforms::default(),
            sheen: SheenUniforms::default(),
            anisotropy: AnisotropyUniforms::default(),
            transmission: TransmissionUniforms::default(),
            specular: SpecularUniforms::default(),
            iridescence: IridescenceUniforms::default(),
            diffuse_transmission: DiffuseTransmissionUniforms::default(),
            subsurface: SubsurfaceUniforms::default(),
        }
    }
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![
        layout_of!(TextureMap { x_axis, y_axis, offset, uv_set, _pad }),
        layout_of!(MaterialUniforms {
            base_color,
            emissive,
            emissive_exposure_weight,
            metallic,
            roughness,
            normal_scale,
            occlusion_strength,
            alpha_cutoff,
            dielectric_f0,
            catcher_strength,
            _pad,
            base_color_map,
            metallic_roughness_map,
            normal_map,
            occlusion_map,
            emissive_map,
            clear_coat,
            sheen,
            anisotropy,
            transmission,
            specular,
            iridescence,
            diffuse_transmission,
            subsurface,
        }),
        layout_of!(SubsurfaceUniforms { color, power, cloth_color, thickness }),
        layout_of!(ClearCoatUniforms { factor, roughness, normal_scale, _pad, map, roughness_map, normal_map }),
        layout_of!(SheenUniforms { color, roughness, color_map, roughness_map }),
        layout_of!(AnisotropyUniforms { rotation, strength, _pad, map }),
        layout_of!(TransmissionUniforms { factor, ior, thickness, dispersion, absorption, _pad, map, thickness_map }),
        layout_of!(SpecularUniforms { color, factor, map, color_map }),
        layout_of!(IridescenceUniforms { factor, ior, min_thickness_nm, max_thickness_nm, map, thickness_map }),
        layout_of!(DiffuseTransmissionUniforms { color, factor, map, color_map }),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computes the matrix product as specified in KHR_texture_transform.
    fn khronos(uv: Vec2, offset: Vec2, rotation: f32, scale: Vec2) -> Vec2 {
        let (s, c) = rotation.sin_cos();
        let translation = glam::Mat3::from_cols(Vec3::X, Vec3::Y, offset.extend(1.0));
        let rotation = glam::Mat3::from_cols(Vec3::new(c, -s, 0.0), Vec3::new(s, c, 0.0), Vec3::Z);
        let scale = glam::Mat3::from_diagonal(scale.extend(1.0));
        (translation * rotation * scale * uv.extend(1.0)).truncate()
    }

    /// Verifies glTF 2.0, 5.19 and 5.22 to 5.24, and KHR_materials_ior; metallic is 0 unless an importer sets it.
    #[test]
    fn defaults_are_those_of_gltf() {
        let m = MaterialUniforms::default();
        assert_eq!((m.base_color, m.emissive, m.emissive_exposure_weight), (Vec4::ONE, Vec3::ZERO, 0.0));
        assert_eq!([m.metallic, m.roughness, m.normal_scale, m.occlusion_strength], [0.0, 1.0, 1.0, 1.0]);
        assert_eq!((m.alpha_cutoff, m.dielectric_f0), (0.5, 0.04));
    }

    #[test]
    fn texture_transforms_follow_the_extension() {
        let (offset, rotation, scale) = (Vec2::new(0.2, -0.4), 0.9, Vec2::new(2.0, 0.5));
        let map = TextureMap::new(1, offset, rotation, scale);
        for uv in [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::new(0.3, 0.8)] {
            let ours = map.offset + map.x_axis * uv.x + map.y_axis * uv.y;
            let theirs = khronos(uv, offset, rotation, scale);
            assert!((ours - theirs).length() < 1e-6, "{uv}: {ours} against {theirs}");
        }
        let none = TextureMap::new(0, Vec2::ZERO, 0.0, Vec2::ONE);
        assert_eq!(none, TextureMap::IDENTITY);
    }
}
