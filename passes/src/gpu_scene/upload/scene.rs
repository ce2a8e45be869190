//! Buffers and textures of a scene on a device.

use std::borrow::Cow;
use std::num::NonZeroU64;

use framegraph_scene::material::SLOT_COUNT;
use framegraph_scene::{Image, Lobes, Material, MaterialId, Memory, MeshId, ProgressFn, Scene, TransparencyMode};
use framegraph_shaders::layout::{MaterialUniforms, TRAIT_DOUBLE_SIDED};
use framegraph_wgpu::{Binding, Gpu};
use wgpu::StencilState;

use super::buffers;
use super::error::UploadError;
use super::instances::InstanceDraw;
use super::material::{TEXTURE_TRAITS, material_traits, material_uniforms, traits_with_textures_of};
use super::mesh_range::{MeshRange, MeshRanges};
use super::stencil::stencil_state;
use super::textures::{Images, MaterialTextures};

/// Buffers and textures of a scene on a device. Dropping it frees them once no submitted work needs them.
#[derive(Debug)]
pub struct GpuScene {
    /// Vertex buffer of `layout::VertexPosition` for all meshes.
    pub positions: wgpu::Buffer,
    /// Vertex buffer of `layout::VertexAttributes` for all meshes.
    pub attributes: wgpu::Buffer,
    /// Indices of all meshes: 32-bit indices, then 16-bit ones ([`MeshRange::short`]).
    pub indices: wgpu::Buffer,
    /// Offset of the 16-bit indices in bytes.
    pub short_indices_at: u64,
    /// `layout::MaterialUniforms` of all materials, `material_stride_bytes` apart.
    pub materials: wgpu::Buffer,
    /// Distance between materials in bytes; a multiple of the device's offset alignment.
    pub material_stride_bytes: u64,
    /// `layout::MaterialUniforms` of all materials as a packed array; `None` if no draw list is long enough to use it.
    pub material_table: Option<wgpu::Buffer>,
    /// One line for each clamped value.
    pub warnings: Vec<String>,
    /// Size of all buffers and textures in bytes, by their descriptors.
    pub size_bytes: u64,
    /// View-independent data for drawing each instance, by instance number.
    pub instances: Vec<InstanceDraw>,
    /// Vertex positions of the previous frame; `None` until a mesh is deformed.
    pub(super) earlier: Option<wgpu::Buffer>,
    meshes: MeshRanges,
    textures: MaterialTextures,
    surfaces: Vec<Surface>,
}

/// Properties of a material that select its pipeline.
#[derive(Clone, Debug)]
struct Surface {
    name: String,
    lobes: Lobes,
    traits: u32,
    stencil: Option<(StencilState, u32)>,
    transparency: TransparencyMode,
}

impl Surface {
    fn of(material: &Material) -> Self {
        let stencil = material.stencil.as_deref().map(|own| (stencil_state(own), own.reference.into()));
        let Material { name, transparency, .. } = material;
        let (lobes, traits) = (material.lobes(), material_traits(material));
        Self { name: name.clone(), lobes, traits, stencil, transparency: *transparency }
    }
}

impl GpuScene {
    /// Uploads `scene`. Returns once the copies are queued; the first submission executes them.
    ///
    /// # Errors
    ///
    /// Fails if an image or a buffer exceeds a limit of the device (the message names both), `progress` stops the
    /// work, or the device fails.
    pub fn upload(gpu: &Gpu, scene: &Scene, progress: &mut ProgressFn<'_>) -> Result<Self, UploadError> {
        let images = scene.images.iter().map(Cow::Borrowed).collect();
        Self::with_images(gpu, scene, images, &Memory::unlimited(), progress)
    }

    /// Uploads a scene that is not uploaded again. Frees the texels of each image once they are on the device. Mip
    /// levels and copies use at most `memory`.
    ///
    /// # Errors
    ///
    /// Fails as [`GpuScene::upload`] does, and if an image does not fit into the memory.
    pub fn upload_freeing(
        gpu: &Gpu,
        scene: &mut Scene,
        memory: &Memory,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, UploadError> {
        let bare = |image: &Image| Image { levels: Vec::new(), name: image.name.clone(), ..*image };
        let bare = scene.images.iter().map(bare).collect();
        let images = std::mem::replace(&mut scene.images, bare).into_iter().map(Cow::Owned).collect();
        Self::with_images(gpu, scene, images, memory, progress)
    }

    fn with_images(
        gpu: &Gpu,
        scene: &Scene,
        images: Images<'_>,
        memory: &Memory,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, UploadError> {
        let mut warnings = Vec::new();
        let (vertices, meshes) = buffers::vertices(gpu, scene, &mut warnings, progress)?;
        let (materials, material_stride_bytes) = buffers::materials(gpu, scene)?;
        let material_table = buffers::material_table(gpu, scene)?;
        let textures = MaterialTextures::upload(gpu, scene, images, memory, progress)?;
        let buffers = [&vertices.positions, &vertices.attributes, &vertices.indices, &materials];
        let buffers = buffers.into_iter().chain(&material_table);
        let size_bytes = buffers.map(wgpu::Buffer::size).sum::<u64>() + textures.size_bytes();
        Ok(Self {
            positions: vertices.positions,
            attributes: vertices.attributes,
            indices: vertices.indices,
            short_indices_at: vertices.short_indices_at,
            materials,
            material_stride_bytes,
            material_table,
            warnings,
            size_bytes,
            instances: scene.instances.iter().map(InstanceDraw::new).collect(),
            earlier: None,
            meshes,
            textures,
            surfaces: scene.materials.iter().map(Surface::of).collect(),
        })
    }

    /// Returns the range of a mesh in a level of detail; 0 is the mesh itself. Clamps to the coarsest level.
    ///
    /// # Panics
    ///
    /// Panics if the scene has no such mesh.
    #[must_use]
    pub fn mesh(&self, mesh: MeshId, level: u8) -> MeshRange {
        self.meshes.of(mesh, level)
    }

    /// Returns the lobes of a material.
    ///
    /// # Panics
    ///
    /// Panics if the scene has no such material.
    #[must_use]
    pub fn lobes(&self, material: MaterialId) -> Lobes {
        self.surfaces[material.index()].lobes
    }

    /// Returns the traits of a material, which select its pipeline ([`material_traits`]).
    ///
    /// # Panics
    ///
    /// Panics if the scene has no such material.
    #[must_use]
    pub fn traits(&self, material: MaterialId) -> u32 {
        self.surfaces[material.index()].traits
    }

    /// Returns the stencil state and reference of a material; `None` if it has none.
    ///
    /// # Panics
    ///
    /// Panics if the scene has no such material.
    #[must_use]
    pub(crate) fn stencil(&self, material: MaterialId) -> Option<&(StencilState, u32)> {
        self.surfaces[material.index()].stencil.as_ref()
    }

    /// Returns the transparency mode of a blended material.
    ///
    /// # Panics
    ///
    /// Panics if the scene has no such material.
    #[must_use]
    pub fn transparency(&self, material: MaterialId) -> TransparencyMode {
        self.surfaces[material.index()].transparency
    }

    /// Returns true if back faces of a material are drawn.
    ///
    /// # Panics
    ///
    /// Panics if the scene has no such material.
    #[must_use]
    pub fn is_double_sided(&self, material: MaterialId) -> bool {
        self.traits(material) & 1 << TRAIT_DOUBLE_SIDED != 0
    }

    /// Returns true if a material can be read from the [table](Self::material_table): the table exists, and the
    /// material has no textures.
    ///
    /// # Panics
    ///
    /// Panics if the scene has no such material.
    #[must_use]
    pub fn is_in_table(&self, material: MaterialId) -> bool {
        self.material_table.is_some() && self.traits(material) & TEXTURE_TRAITS == 0
    }

    /// Returns the name of a material, for messages; may be empty.
    ///
    /// # Panics
    ///
    /// Panics if the scene has no such material.
    #[must_use]
    pub fn material_name(&self, material: MaterialId) -> &str {
        &self.surfaces[material.index()].name
    }

    /// Updates the factors of a material for later submissions. Textures are unchanged, and lobes must not change,
    /// since they select the shader. Make views again if their draws or feature culling depend on a changed factor
    /// (alpha, emission).
    ///
    /// # Errors
    ///
    /// Fails if the material does not exist, or its lobes change.
    pub fn write_material(&mut self, gpu: &Gpu, id: MaterialId, material: &Material) -> Result<(), UploadError> {
        let surface = self.surfaces.get_mut(id.index());
        let Some(surface) = surface.filter(|surface| surface.lobes == material.lobes()) else {
            let (name, number) = (material.name.clone(), id.index());
            return Err(UploadError::OtherMaterial { name, number });
        };
        surface.traits = traits_with_textures_of(surface.traits, material);
        surface.stencil = Surface::of(material).stencil;
        let (number, packed) = (id.index() as u64, material_uniforms(material));
        gpu.queue.write_buffer(&self.materials, number * self.material_stride_bytes, bytemuck::bytes_of(&packed));
        if let Some(table) = &self.material_table {
            let offset = number * size_of::<MaterialUniforms>() as u64;
            gpu.queue.write_buffer(table, offset, bytemuck::bytes_of(&packed));
        }
        Ok(())
    }

    /// Returns the binding of a material's variable, by index in [`MATERIAL_BINDINGS`](super::MATERIAL_BINDINGS). A
    /// missing texture is replaced by a neutral one. `None` beyond the last index.
    ///
    /// # Panics
    ///
    /// Panics if the scene has no such material.
    #[must_use]
    pub fn material_binding(&self, material: MaterialId, index: usize) -> Option<Binding> {
        let Some(index) = index.checked_sub(1) else {
            return Some(Binding::Buffer {
                buffer: self.materials.clone(),
                offset: material.index() as u64 * self.material_stride_bytes,
                bytes: NonZeroU64::new(size_of::<MaterialUniforms>() as u64),
            });
        };
        let Some((view, sampler)) = self.textures.of_material(material).get(index / 2) else {
            return (index == 2 * SLOT_COUNT).then(|| self.material_table.clone().map(Binding::from))?;
        };
        Some(if index.is_multiple_of(2) { view.clone().into() } else { sampler.clone().into() })
    }
}
