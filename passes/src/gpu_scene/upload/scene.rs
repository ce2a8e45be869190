//! A scene's resources on one device.

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

/// A scene's resources on one device. Dropping it frees them once no submitted work needs them.
#[derive(Debug)]
pub struct GpuScene {
    /// Vertex buffer of `layout::VertexPosition`, all meshes.
    pub positions: wgpu::Buffer,
    /// Vertex buffer of `layout::VertexAttributes`, all meshes.
    pub attributes: wgpu::Buffer,
    /// Indices of all meshes: those of 32 bits, and behind them those of 16 ([`MeshRange::short`]).
    pub indices: wgpu::Buffer,
    /// Where those of 16 bits begin, in bytes.
    pub short_indices_at: u64,
    /// `layout::MaterialUniforms` of all materials, `material_stride_bytes` apart.
    pub materials: wgpu::Buffer,
    /// From one material to the next; a multiple of the device's offset alignment.
    pub material_stride_bytes: u64,
    /// `layout::MaterialUniforms` of all materials, one after another; none where no list of draws is long enough to use it.
    pub material_table: Option<wgpu::Buffer>,
    /// Values that were clamped, a line each.
    pub warnings: Vec<String>,
    /// Bytes of all buffers and textures, as their descriptors say.
    pub size_bytes: u64,
    /// What drawing each instance takes, by its number.
    pub instances: Vec<InstanceDraw>,
    /// Where vertices were in the frame before; none while no body has moved.
    pub(super) earlier: Option<wgpu::Buffer>,
    meshes: MeshRanges,
    textures: MaterialTextures,
    surfaces: Vec<Surface>,
}

/// A material's properties that decide how it is drawn.
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
    /// Copies `scene` to the device. Returns once the copies are queued; the first submission
    /// carries them out.
    ///
    /// # Errors
    ///
    /// When an image or a buffer exceeds the device's limits (the message names file and limit),
    /// when `progress` asks to stop, or when the device fails.
    pub fn upload(gpu: &Gpu, scene: &Scene, progress: &mut ProgressFn<'_>) -> Result<Self, UploadError> {
        let images = scene.images.iter().map(Cow::Borrowed).collect();
        Self::with_images(gpu, scene, images, &Memory::unlimited(), progress)
    }

    /// The same for a scene that is not uploaded again: each image loses its texels as soon as they are on the device. What
    /// mip levels and copies take stays within `memory`, to which the texels are given back.
    ///
    /// # Errors
    ///
    /// As [`GpuScene::upload`], and when an image does not fit into the memory.
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

    /// The part of the buffers that holds a mesh in a level of detail, 0 for the mesh itself; the coarsest where it has fewer.
    ///
    /// # Panics
    ///
    /// For a mesh of another, larger scene.
    #[must_use]
    pub fn mesh(&self, mesh: MeshId, level: u8) -> MeshRange {
        self.meshes.of(mesh, level)
    }

    /// The lobes that shading a material has to evaluate.
    ///
    /// # Panics
    ///
    /// For a material of another, larger scene.
    #[must_use]
    pub fn lobes(&self, material: MaterialId) -> Lobes {
        self.surfaces[material.index()].lobes
    }

    /// What a material has, of which its pipelines are made ([`material_traits`]).
    ///
    /// # Panics
    ///
    /// For a material of another, larger scene.
    #[must_use]
    pub fn traits(&self, material: MaterialId) -> u32 {
        self.surfaces[material.index()].traits
    }

    /// The stencil state of pipelines that draw a material, and its reference; `None` for one that has none.
    ///
    /// # Panics
    ///
    /// For a material of another, larger scene.
    #[must_use]
    pub(crate) fn stencil(&self, material: MaterialId) -> Option<&(StencilState, u32)> {
        self.surfaces[material.index()].stencil.as_ref()
    }

    /// Transparency mode of a blended material.
    ///
    /// # Panics
    ///
    /// For a material of another, larger scene.
    #[must_use]
    pub fn transparency(&self, material: MaterialId) -> TransparencyMode {
        self.surfaces[material.index()].transparency
    }

    /// Whether back faces of a material are drawn too.
    ///
    /// # Panics
    ///
    /// For a material of another, larger scene.
    #[must_use]
    pub fn is_double_sided(&self, material: MaterialId) -> bool {
        self.traits(material) & 1 << TRAIT_DOUBLE_SIDED != 0
    }

    /// Whether a material can be taken from the [table](Self::material_table): there is one, and it has no textures.
    ///
    /// # Panics
    ///
    /// For a material of another, larger scene.
    #[must_use]
    pub fn is_in_table(&self, material: MaterialId) -> bool {
        self.material_table.is_some() && self.traits(material) & TEXTURE_TRAITS == 0
    }

    /// The name of a material, for messages; may be empty.
    ///
    /// # Panics
    ///
    /// For a material of another, larger scene.
    #[must_use]
    pub fn material_name(&self, material: MaterialId) -> &str {
        &self.surfaces[material.index()].name
    }

    /// Writes the factors of a material anew, for what is submitted from then on. Its textures stay, and its lobes must: they
    /// choose the shader. Views of a scene whose facts or draws depend on a factor (alpha, emission) are the caller's to make
    /// anew.
    ///
    /// # Errors
    ///
    /// When the material has other lobes than the one that was uploaded, or there was none of that number.
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

    /// What to bind to a variable of a material, by its index in [`MATERIAL_BINDINGS`](super::MATERIAL_BINDINGS). A material
    /// without a texture binds a neutral one. `None` beyond the end.
    ///
    /// # Panics
    ///
    /// For a material of another, larger scene.
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
