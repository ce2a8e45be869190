//! Mirror of `wgsl/interface/material.wgsl`. The uniforms of lobes that a material lacks hold their defaults and are not
//! read.

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3, Vec4};

/// Bit of [`MaterialUniforms::flags`]: base color is the result (KHR_materials_unlit).
pub const MATERIAL_UNLIT: u32 = 1;
/// Bit of [`MaterialUniforms::flags`]: back faces are seen and shaded with turned normals.
pub const MATERIAL_DOUBLE_SIDED: u32 = 2;

/// Where a texture lies on the mesh, and whether there is one.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct TextureMap {
    /// First column of rotation · scale.
    pub x_axis: Vec2,
    /// Second column.
    pub y_axis: Vec2,
    /// Added last.
    pub offset: Vec2,
    /// Texture coordinate set, 0 or 1.
    pub uv_set: u32,
    /// 1 where the texture exists.
    pub present: u32,
}

impl Default for TextureMap {
    fn default() -> Self {
        Self::ABSENT
    }
}

impl TextureMap {
    /// No texture: the factor alone counts.
    pub const ABSENT: Self = Self { x_axis: Vec2::X, y_axis: Vec2::Y, offset: Vec2::ZERO, uv_set: 0, present: 0 };

    /// A texture with the transform of KHR_texture_transform, offset · rotation · scale:
    /// `rotation_rad` counter-clockwise in texture space, whose v runs downward.
    pub fn new(uv_set: u32, offset: Vec2, rotation_rad: f32, scale: Vec2) -> Self {
        let (sin, cos) = rotation_rad.sin_cos();
        Self {
            x_axis: Vec2::new(cos, -sin) * scale.x,
            y_axis: Vec2::new(sin, cos) * scale.y,
            offset,
            uv_set,
            present: 1,
        }
    }
}

/// Factors of a glTF metallic-roughness material and of its lobes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct MaterialUniforms {
    /// Linear Rec.709 and straight alpha.
    pub base_color: Vec4,
    /// Emitted radiance, emissive strength included.
    pub emissive: Vec3,
    /// 1: `emissive` is in nits; 0: in display values.
    pub emissive_exposure_weight: f32,
    /// 0 dielectric … 1 metal.
    pub metallic: f32,
    /// Perceptual roughness.
    pub roughness: f32,
    /// Factor on x and y of the normal map.
    pub normal_scale: f32,
    /// How far the occlusion texture counts.
    pub occlusion_strength: f32,
    /// MASK: least alpha that is there.
    pub alpha_cutoff: f32,
    /// Reflectance of the dielectric part at normal incidence.
    pub dielectric_f0: f32,
    /// `MATERIAL_*` bits.
    pub flags: u32,
    /// Fills the row.
    pub _pad: u32,
    /// Base color texture.
    pub base_color_map: TextureMap,
    /// Metallic-roughness texture.
    pub metallic_roughness_map: TextureMap,
    /// Normal texture.
    pub normal_map: TextureMap,
    /// Occlusion texture.
    pub occlusion_map: TextureMap,
    /// Emissive texture.
    pub emissive_map: TextureMap,
    /// Read with `CLEAR_COAT`.
    pub clear_coat: ClearCoatUniforms,
    /// Read with `SHEEN`.
    pub sheen: SheenUniforms,
    /// Read with `ANISOTROPY`.
    pub anisotropy: AnisotropyUniforms,
    /// Read with `TRANSMISSION`.
    pub transmission: TransmissionUniforms,
    /// Read with `SPECULAR`.
    pub specular: SpecularUniforms,
}

/// KHR_materials_clearcoat.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ClearCoatUniforms {
    /// How much of the surface is coated, 0…1.
    pub factor: f32,
    /// Perceptual roughness of the coat.
    pub roughness: f32,
    /// Factor on x and y of the coat's normal map.
    pub normal_scale: f32,
    /// Fills the row.
    pub _pad: u32,
    /// Factor texture.
    pub map: TextureMap,
    /// Roughness texture.
    pub roughness_map: TextureMap,
    /// Normal texture.
    pub normal_map: TextureMap,
}

/// KHR_materials_sheen.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SheenUniforms {
    /// Reflectance of the fibers, linear Rec.709.
    pub color: Vec3,
    /// Perceptual roughness.
    pub roughness: f32,
    /// Color texture.
    pub color_map: TextureMap,
    /// Roughness texture.
    pub roughness_map: TextureMap,
}

/// KHR_materials_anisotropy.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct AnisotropyUniforms {
    /// Cosine and sine of the rotation from the tangent.
    pub rotation: Vec2,
    /// 0…1.
    pub strength: f32,
    /// Fills the row.
    pub _pad: u32,
    /// Direction and strength.
    pub map: TextureMap,
}

/// KHR_materials_transmission and KHR_materials_volume.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TransmissionUniforms {
    /// Share of the light that enters which is transmitted, 0…1.
    pub factor: f32,
    /// Index of refraction, 1 or more.
    pub ior: f32,
    /// Depth of the body in units of the mesh; 0 is a thin wall.
    pub thickness: f32,
    /// Fills the row.
    pub _pad0: u32,
    /// Absorption per meter.
    pub absorption: Vec3,
    /// Fills the row.
    pub _pad1: u32,
    /// Factor texture.
    pub map: TextureMap,
    /// Thickness texture.
    pub thickness_map: TextureMap,
}

/// KHR_materials_specular.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SpecularUniforms {
    /// Factor on the dielectric's reflectance at normal incidence, linear Rec.709.
    pub color: Vec3,
    /// Factor on all of the dielectric's reflection, 0…1.
    pub factor: f32,
    /// Factor texture.
    pub map: TextureMap,
    /// Color texture.
    pub color_map: TextureMap,
}

impl Default for MaterialUniforms {
    /// The defaults of glTF 2.0, but for `metallic`, which is 0 here: without a texture glTF's
    /// 1 makes everything a metal, and importers always set it.
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
            flags: 0,
            _pad: 0,
            base_color_map: TextureMap::ABSENT,
            metallic_roughness_map: TextureMap::ABSENT,
            normal_map: TextureMap::ABSENT,
            occlusion_map: TextureMap::ABSENT,
            emissive_map: TextureMap::ABSENT,
            clear_coat: ClearCoatUniforms::default(),
            sheen: SheenUniforms::default(),
            anisotropy: AnisotropyUniforms::default(),
            transmission: TransmissionUniforms::default(),
            specular: SpecularUniforms::default(),
        }
    }
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![
        layout_of!(TextureMap { x_axis, y_axis, offset, uv_set, present }),
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
            flags,
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
        }),
        layout_of!(ClearCoatUniforms { factor, roughness, normal_scale, _pad, map, roughness_map, normal_map }),
        layout_of!(SheenUniforms { color, roughness, color_map, roughness_map }),
        layout_of!(AnisotropyUniforms { rotation, strength, _pad, map }),
        layout_of!(TransmissionUniforms { factor, ior, thickness, _pad0, absorption, _pad1, map, thickness_map }),
        layout_of!(SpecularUniforms { color, factor, map, color_map }),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The matrix product that KHR_texture_transform spells out.
    fn khronos(uv: Vec2, offset: Vec2, rotation: f32, scale: Vec2) -> Vec2 {
        let (s, c) = rotation.sin_cos();
        let translation = glam::Mat3::from_cols(Vec3::X, Vec3::Y, offset.extend(1.0));
        let rotation = glam::Mat3::from_cols(Vec3::new(c, -s, 0.0), Vec3::new(s, c, 0.0), Vec3::Z);
        let scale = glam::Mat3::from_diagonal(scale.extend(1.0));
        (translation * rotation * scale * uv.extend(1.0)).truncate()
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
        assert_eq!(TextureMap { present: 0, ..none }, TextureMap::ABSENT);
    }
}
