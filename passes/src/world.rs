//! What recorders are handed: the scene on the GPU, its light, the view, and the shaders.

use crate::ibl::IblError;
use crate::lighting::Lighting;
use crate::program::Programs;
use crate::upload::{GpuScene, UploadError};
use crate::view::View;
use framegraph_scene::{Instance, MaterialId, MeshId, ProgressFn, Scene};
use framegraph_shaders::ShaderError;
use framegraph_wgpu::{DeviceError, Gpu};
use wgpu::{Buffer, BufferDescriptor, BufferUsages};

/// Everything a recorder of the standard frame reads. Kept from frame to frame; [`World::set_view`] changes the moment.
#[derive(Debug)]
pub struct World {
    /// Shaders with their bindings.
    pub programs: Programs,
    /// Meshes, materials and textures on the GPU.
    pub scene: GpuScene,
    /// Which mesh and material each instance has.
    pub instances: Vec<Placed>,
    /// What lights it from all around. May be replaced between frames, with a view that was made of it.
    pub lighting: Lighting,
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
    /// Light could not be made of the environment, or making it was interrupted.
    #[error(transparent)]
    Light(#[from] IblError),
    /// The device failed.
    #[error(transparent)]
    Device(#[from] DeviceError),
}

impl World {
    /// Uploads a scene. `view` must be of the same scene and the same light.
    ///
    /// # Errors
    /// [`WorldError`].
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        lighting: Lighting,
        view: View,
        progress: &mut ProgressFn<'_>,
    ) -> Result<Self, WorldError> {
        let programs = Programs::new()?;
        let uploaded = GpuScene::upload(gpu, scene, progress)?;
        let made = gpu.guard("uploading what is drawn", || Self {
            programs,
            scene: uploaded,
            instances: scene.instances.iter().map(|i| Placed::of(scene, i)).collect(),
            lighting,
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
