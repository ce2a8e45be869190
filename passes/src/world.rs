//! What recorders are handed: the scene on the GPU, the view, the shaders, and the tables that shading reads.

use crate::program::Programs;
use crate::view::View;
use half::f16;
use renderer::scene::upload::{GpuEnvironment, GpuScene, UploadError};
use renderer::scene::{Environment, Instance, MaterialId, MeshId, ProgressFn, Scene};
use renderer::wgpu::{DeviceError, Gpu};
use shaders::ShaderError;
use shaders::reference::dfg::{Visibility, dfg_table};
use wgpu::util::{DeviceExt, TextureDataOrder};
use wgpu::{
    Buffer, BufferDescriptor, BufferUsages, Extent3d, TextureDescriptor, TextureDimension, TextureFormat,
    TextureUsages, TextureView,
};

/// Width and height of the DFG table: 64 texels err at most 0.006.
const DFG_TEXELS: u32 = 64;
/// Visible-normal samples a texel of the table: 128 reach an RMS error of 0.002.
const DFG_SAMPLES: u32 = 128;

/// Everything a recorder of the standard frame reads. Kept from frame to frame; [`World::set_view`] changes the moment.
#[derive(Debug)]
pub struct World {
    /// Shaders with their bindings.
    pub programs: Programs,
    /// Meshes, materials and textures on the GPU.
    pub scene: GpuScene,
    /// Which mesh and material each instance has.
    pub instances: Vec<Placed>,
    /// Radiance all around, with its levels.
    pub environment: GpuEnvironment,
    /// Directional albedo of the specular lobe over (n·v, roughness).
    pub dfg: TextureView,
    /// Placement of each instance, by number.
    pub objects: Buffer,
    /// Punctual lights.
    pub lights: Buffer,
    /// The moment: camera, sun, draw lists.
    pub view: View,
}

/// An instance as draws need it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Placed {
    /// Its mesh.
    pub mesh: MeshId,
    /// Its material.
    pub material: MaterialId,
    /// Both sides of its triangles are seen.
    pub double_sided: bool,
    /// Its transform turns triangles around.
    pub mirrored: bool,
}

/// The world cannot be set up.
#[derive(Debug, thiserror::Error)]
pub enum WorldError {
    /// A shader is wrong.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// The scene does not fit the device, or loading was interrupted.
    #[error(transparent)]
    Scene(#[from] UploadError),
    /// The device failed.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl World {
    /// Uploads a scene with its environment and computes the tables.
    ///
    /// # Errors
    /// [`WorldError`].
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        environment: &Environment,
        view: View,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, WorldError> {
        let programs = Programs::new()?;
        let uploaded = GpuScene::upload(gpu, scene, progress)?;
        let environment = GpuEnvironment::upload(gpu, environment, progress)?;
        let made = gpu.guard("uploading the tables of shading", || Self {
            programs,
            scene: uploaded,
            instances: scene.instances.iter().map(|i| Placed::of(scene, i)).collect(),
            environment,
            dfg: dfg(gpu),
            objects: storage(gpu, "objects", bytemuck::cast_slice(&view.objects)),
            lights: storage(gpu, "lights", bytemuck::cast_slice(&view.lights)),
            view,
        })?;
        Ok(made)
    }

    /// Changes the moment. Buffers are reused while they are large enough.
    pub fn set_view(&mut self, gpu: &Gpu, view: View) {
        refill(gpu, &mut self.objects, "objects", bytemuck::cast_slice(&view.objects));
        refill(gpu, &mut self.lights, "lights", bytemuck::cast_slice(&view.lights));
        self.view = view;
    }
}

impl Placed {
    fn of(scene: &Scene, instance: &Instance) -> Self {
        let Instance { mesh, material, .. } = *instance;
        let double_sided = scene.materials[material.index()].double_sided;
        Self { mesh, material, double_sided, mirrored: instance.is_mirrored() }
    }
}

/// A storage buffer of these bytes; never empty, since an empty one cannot be bound.
fn storage(gpu: &Gpu, label: &str, bytes: &[u8]) -> Buffer {
    let usage = BufferUsages::STORAGE | BufferUsages::COPY_DST;
    let size = (bytes.len() as u64).max(256);
    let buffer =
        gpu.device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false });
    gpu.queue.write_buffer(&buffer, 0, bytes);
    buffer
}

fn refill(gpu: &Gpu, buffer: &mut Buffer, label: &str, bytes: &[u8]) {
    if bytes.len() as u64 <= buffer.size() {
        gpu.queue.write_buffer(buffer, 0, bytes);
    } else {
        *buffer = storage(gpu, label, bytes);
    }
}

/// The table of the exact height-correlated visibility term.
fn dfg(gpu: &Gpu) -> TextureView {
    let table = dfg_table(DFG_TEXELS, Visibility::Exact, DFG_SAMPLES);
    let texels: Vec<[f16; 2]> = table.iter().map(|t| t.map(f16::from_f32)).collect();
    let desc = TextureDescriptor {
        label: Some("dfg"),
        size: Extent3d { width: DFG_TEXELS, height: DFG_TEXELS, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: TextureDimension::D2,
        format: TextureFormat::Rg16Float,
        usage: TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    let bytes = bytemuck::cast_slice(&texels);
    gpu.device
        .create_texture_with_data(&gpu.queue, &desc, TextureDataOrder::LayerMajor, bytes)
        .create_view(&Default::default())
}
