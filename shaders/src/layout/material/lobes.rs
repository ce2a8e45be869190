//! Factors of the lobes of a material; those that a material lacks hold their defaults and are not read.

use bytemuck::{Pod, Zeroable};
use glam::{Vec2, Vec3};

use super::TextureMap;

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
