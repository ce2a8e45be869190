//! The scene on the GPU: buffers, textures and samplers, in the layout of `shaders::layout`.
//!
//! One buffer holds the positions of all meshes, one their other attributes, one their indices, one
//! the factors of all materials; draws say where in them. Images are uploaded once for each role
//! they play, with mip levels made here, on all cores. Bind groups are the passes' business:
//! [`GpuScene::material_bindings`] says what goes into the material's.

mod buffers;
mod environment;
mod textures;

use std::num::NonZeroU64;

use shaders::layout::MaterialUniforms;

use self::textures::MaterialTextures;
use super::Scene;
use super::error::SceneError;
use super::id::{MaterialId, MeshId};
use super::progress::ProgressFn;
use crate::wgpu::{Binding, DeviceError, Gpu};

pub use environment::GpuEnvironment;

/// Why a scene did not reach the GPU.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum UploadError {
    /// Something of it exceeds a limit of the device, or the upload was interrupted.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The device refused, ran out of memory, or was lost.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

/// Where a mesh lies in the shared buffers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MeshRange {
    /// First index of the mesh in [`GpuScene::indices`].
    pub first_index: u32,
    /// Three a triangle.
    pub index_count: u32,
    /// Added to every index.
    pub base_vertex: i32,
}

impl MeshRange {
    /// The indices to draw.
    #[must_use]
    pub fn indices(&self) -> std::ops::Range<u32> {
        self.first_index..self.first_index + self.index_count
    }
}

/// A scene's resources on one device. Dropping it frees them once no submitted work needs them.
#[derive(Debug)]
pub struct GpuScene {
    /// `layout::VertexPosition` of all meshes.
    pub positions: wgpu::Buffer,
    /// `layout::VertexAttributes` of all meshes.
    pub attributes: wgpu::Buffer,
    /// 32-bit indices of all meshes.
    pub indices: wgpu::Buffer,
    /// `layout::MaterialUniforms` of all materials, `material_stride_bytes` apart.
    pub materials: wgpu::Buffer,
    /// From one material to the next; a multiple of the device's offset alignment.
    pub material_stride_bytes: u64,
    /// What was cut or left out, a line each.
    pub warnings: Vec<String>,
    /// Bytes of all buffers and textures, as their descriptors say.
    pub size_bytes: u64,
    meshes: Vec<MeshRange>,
    textures: MaterialTextures,
}

impl GpuScene {
    /// Copies `scene` to the device. Returns once the copies are queued; the first submission
    /// carries them out.
    ///
    /// # Errors
    ///
    /// When an image or a buffer exceeds the device's limits (the message names file and limit),
    /// when `progress` asks to stop, or when the device fails.
    pub fn upload(gpu: &Gpu, scene: &Scene, progress: &mut ProgressFn<'_>) -> Result<Self, UploadError> {
        let mut warnings = Vec::new();
        let (vertices, meshes) = buffers::vertices(gpu, scene, &mut warnings)?;
        let (materials, material_stride_bytes) = buffers::materials(gpu, scene)?;
        let textures = MaterialTextures::upload(gpu, scene, progress)?;
        let buffers = [&vertices.positions, &vertices.attributes, &vertices.indices, &materials];
        let size_bytes = buffers.iter().map(|b| b.size()).sum::<u64>() + textures.size_bytes();
        Ok(Self {
            positions: vertices.positions,
            attributes: vertices.attributes,
            indices: vertices.indices,
            materials,
            material_stride_bytes,
            warnings,
            size_bytes,
            meshes,
            textures,
        })
    }

    /// Where a mesh lies in the buffers.
    ///
    /// # Panics
    ///
    /// For a mesh of another, larger scene.
    #[must_use]
    pub fn mesh(&self, mesh: MeshId) -> MeshRange {
        self.meshes[mesh.index()]
    }

    /// What group 1 of `wgsl/interface/material.wgsl` binds for a material: the factors at 0, the
    /// five textures at 1 to 5, their samplers at 6 to 10. A material without a texture binds a
    /// neutral one.
    ///
    /// # Panics
    ///
    /// For a material of another, larger scene.
    #[must_use]
    pub fn material_bindings(&self, material: MaterialId) -> [(u32, Binding); 11] {
        let offset = material.index() as u64 * self.material_stride_bytes;
        let factors = Binding::Buffer {
            buffer: self.materials.clone(),
            offset,
            bytes: NonZeroU64::new(size_of::<MaterialUniforms>() as u64),
        };
        let slots = self.textures.of_material(material);
        std::array::from_fn(|i| {
            let binding = match i {
                0 => factors.clone(),
                1..=5 => slots[i - 1].0.clone().into(),
                _ => slots[i - 6].1.clone().into(),
            };
            (i as u32, binding)
        })
    }
}

#[cfg(test)]
mod tests;
