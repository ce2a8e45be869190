//! Views of a frame on the GPU.
//!
//! Each view has its own buffers for eye-relative data and draw lists. All views share the meshes, materials and
//! textures of the scene. Rotation and scale of instances are uploaded once, and again after a change.

use super::CameraView;
use crate::error::PassError;
use crate::gpu_scene::draw::InstanceSource;
use crate::gpu_scene::indirect::draws_indirectly;
use crate::gpu_scene::placements::Placements;
use crate::gpu_scene::shadow_views::ViewShadows;
use crate::gpu_scene::streams::Instances;
use crate::gpu_scene::upload::GpuScene;
use bytemuck::cast_slice;
use framegraph_shaders::layout::{ObjectAttributes, ObjectUniforms};
use framegraph_wgpu::{DeviceError, Gpu};
use glam::DVec2;
use wgpu::{Buffer, BufferDescriptor, BufferUsages};

/// Index of a view of the frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ViewId(pub u32);

impl ViewId {
    /// First view, which every world has.
    pub const MAIN: Self = Self(0);
}

/// A view with its buffers.
#[derive(Debug)]
pub struct GpuView {
    /// View on the CPU.
    pub view: CameraView,
    /// `layout::MotionUniforms` of each instance, if any instance moves.
    pub motions: Buffer,
    /// `layout::LightUniforms` of the punctual lights.
    pub lights: Buffer,
    /// Light lists by froxel.
    pub light_lists: Buffer,
    /// `layout::ShadowMapUniforms` of the shadow maps of punctual lights.
    pub local_maps: Buffer,
    /// `layout::ObjectUniforms` of each instance, by its number; and those that were uploaded.
    objects: Buffer,
    uploaded: Placements,
    /// Points that translations of instances are relative to, relative to the eye.
    origins: Buffer,
    /// Instance stream: `layout::ObjectAttributes` if objects are streamed, otherwise instance numbers.
    instances: Buffer,
    /// Streamed objects; kept to reuse the allocation.
    streamed: Vec<ObjectAttributes>,
    /// Arguments of indirect draws.
    arguments: Buffer,
    pub(crate) id: ViewId,
}

impl GpuView {
    fn new(gpu: &Gpu, id: ViewId, view: CameraView) -> Self {
        let storage = |label| buffer(gpu, label, BufferUsages::STORAGE, 0);
        let mut own = Self {
            objects: storage("objects"),
            uploaded: Placements::default(),
            motions: storage("motions"),
            origins: storage("origins"),
            instances: buffer(gpu, "instances", BufferUsages::VERTEX, 0),
            streamed: Vec::new(),
            arguments: buffer(gpu, "draws", BufferUsages::INDIRECT, 0),
            lights: storage("lights"),
            light_lists: storage("light lists"),
            local_maps: storage("local maps"),
            view,
            id,
        };
        own.fill(gpu);
        own
    }

    /// Uploads the view.
    fn fill(&mut self, gpu: &Gpu) {
        let view = &self.view;
        let light_words = view.light_lists.as_ref().map_or(&[][..], |lists| &lists.words);
        let maps = view.shadows.as_ref().map(ViewShadows::local_uniforms).unwrap_or_default();
        let storage = BufferUsages::STORAGE;
        refill(gpu, &mut self.motions, "motions", storage, cast_slice(&view.motions));
        if draws_indirectly(gpu) {
            refill(gpu, &mut self.arguments, "draws", BufferUsages::INDIRECT, cast_slice(&view.draws.arguments));
        }
        refill(gpu, &mut self.lights, "lights", storage, cast_slice(&view.lights));
        refill(gpu, &mut self.light_lists, "light lists", storage, cast_slice(light_words));
        refill(gpu, &mut self.local_maps, "local maps", storage, cast_slice(&maps));
        if view.streams_objects {
            let attributes = |number: &u32| {
                let index = *number as usize;
                ObjectAttributes::new(*number, view.placements.object(index), view.origins[index])
            };
            self.streamed.clear();
            self.streamed.extend(view.draws.numbers.iter().map(attributes));
            refill(gpu, &mut self.instances, "instances", BufferUsages::VERTEX, cast_slice(&self.streamed));
            return;
        }
        refill(gpu, &mut self.instances, "instances", BufferUsages::VERTEX, cast_slice(&view.draws.numbers));
        refill(gpu, &mut self.origins, "origins", storage, cast_slice(&view.origins));
        let placements = &view.placements;
        assert!(
            !placements.is_released(),
            "a view is uploaded once; make another one instead of copying `GpuView::view`"
        );
        let bytes = (placements.count() * size_of::<ObjectUniforms>()) as u64;
        if fit(gpu, &mut self.objects, "objects", BufferUsages::STORAGE, bytes) {
            self.uploaded = Placements::default();
        }
        for (first, piece) in placements.changed_since(&self.uploaded) {
            let offset = (first * size_of::<ObjectUniforms>()) as u64;
            gpu.queue.write_buffer(&self.objects, offset, cast_slice(piece));
        }
        self.view.placements.release();
        self.uploaded = self.view.placements.clone();
    }

    /// Returns the source that the view's instances are drawn from.
    pub fn instances<'a>(&'a self, scene: &'a GpuScene) -> InstanceSource<'a> {
        let Self { objects, origins, instances, arguments, view, .. } = self;
        let instances = match view.streams_objects {
            true => Instances::Stream(instances),
            false => Instances::Numbers { numbers: instances, objects, origins },
        };
        InstanceSource { scene, instances, arguments, stencil: false }
    }

    /// Returns the view's shadow maps, for a frame with `declared` layers of them.
    ///
    /// # Errors
    /// Fails if the maps have another number of layers.
    pub fn shadows(&self, declared: u16) -> Result<&ViewShadows, PassError> {
        let shadows = self.view.shadows.as_ref();
        let layers = shadows.map_or(0, |shadows| shadows.settings.layers());
        let fitting = shadows.filter(|_| layers == declared);
        fitting.ok_or(PassError::ShadowMaps { declared, view: self.id.0, layers })
    }
}

/// Views of a frame, kept across frames. [`Views::set`] replaces one.
#[derive(Debug, Default)]
pub struct Views(Vec<GpuView>);

impl Views {
    /// Uploads views. The first is [`ViewId::MAIN`].
    ///
    /// # Errors
    /// Fails if the device cannot create a buffer.
    ///
    /// # Panics
    /// Panics for a copy of an uploaded view ([`GpuView::view`]), which no longer has the data for shaders.
    pub fn new(gpu: &Gpu, views: impl IntoIterator<Item = CameraView>) -> Result<Self, DeviceError> {
        gpu.guard("buffers of views", || {
            let view = |(number, view)| GpuView::new(gpu, ViewId(number), view);
            Self((0..).zip(views).map(view).collect())
        })
    }

    /// Replaces a view. Reuses buffers that are large enough.
    ///
    /// # Errors
    /// Fails if the view does not exist.
    ///
    /// # Panics
    /// Panics for a copy of an uploaded view ([`GpuView::view`]), which no longer has the data for shaders.
    pub fn set(&mut self, gpu: &Gpu, id: ViewId, view: CameraView) -> Result<(), PassError> {
        let count = self.0.len();
        let own = self.0.get_mut(id.0 as usize).ok_or(PassError::NoView { view: id.0, count })?;
        own.view = view;
        own.fill(gpu);
        Ok(())
    }

    /// Advances an unchanged view of an unchanged scene to the next frame, with the jitter `jitter_px`. Uploads no
    /// buffer.
    ///
    /// # Errors
    /// Fails if the view does not exist.
    pub fn again(&mut self, id: ViewId, jitter_px: DVec2) -> Result<(), PassError> {
        let count = self.0.len();
        let own = self.0.get_mut(id.0 as usize).ok_or(PassError::NoView { view: id.0, count })?;
        own.view.earlier = Some(own.view.stand());
        own.view.motions.clear();
        own.view.still_frames = own.view.still_frames.saturating_add(1);
        own.view.jitter(jitter_px);
        Ok(())
    }

    /// Returns a view.
    ///
    /// # Errors
    /// Fails if the view does not exist.
    pub fn get(&self, id: ViewId) -> Result<&GpuView, PassError> {
        self.0.get(id.0 as usize).ok_or(PassError::NoView { view: id.0, count: self.0.len() })
    }
}

/// Creates a buffer of at least `bytes` bytes. Never empty, since empty buffers cannot be bound.
fn buffer(gpu: &Gpu, label: &str, usage: BufferUsages, bytes: u64) -> Buffer {
    let (size, usage) = (bytes.max(256), usage | BufferUsages::COPY_DST);
    gpu.device.create_buffer(&BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false })
}

/// Replaces a buffer smaller than `bytes`, and returns true if it did. Growth is geometric.
fn fit(gpu: &Gpu, own: &mut Buffer, label: &str, usage: BufferUsages, bytes: u64) -> bool {
    let is_small = bytes > own.size();
    if is_small {
        let most = gpu.device.limits().max_buffer_size;
        *own = buffer(gpu, label, usage, bytes.max((own.size() + own.size() / 2).min(most)).next_multiple_of(4));
    }
    is_small
}

fn refill(gpu: &Gpu, own: &mut Buffer, label: &str, usage: BufferUsages, bytes: &[u8]) {
    fit(gpu, own, label, usage, bytes.len() as u64);
    gpu.queue.write_buffer(own, 0, bytes);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_view_that_is_not_there_is_named() -> Result<(), Box<dyn std::error::Error>> {
        let views = Views::new(&Gpu::noop()?, [])?;
        assert_eq!(views.get(ViewId(1)).err(), Some(PassError::NoView { view: 1, count: 0 }));
        Ok(())
    }
}
