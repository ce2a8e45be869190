//! Views with their buffers on the device.

use super::CameraView;
use crate::error::PassError;
use crate::shadow::ViewShadows;
use framegraph_wgpu::{DeviceError, Gpu};
use glam::DVec2;
use wgpu::{Buffer, BufferDescriptor, BufferUsages};

/// Which of a frame's views a pass draws.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ViewId(pub u32);

impl ViewId {
    /// The first view, which every world of a scene has.
    pub const MAIN: Self = Self(0);
}

/// A view with its buffers.
#[derive(Debug)]
pub struct GpuView {
    /// The view.
    pub view: CameraView,
    /// `layout::ObjectUniforms` of each instance, by its number.
    pub objects: Buffer,
    /// `layout::LightUniforms` of the punctual lights.
    pub lights: Buffer,
    /// The words of the lists of lights.
    pub light_lists: Buffer,
    /// `layout::ShadowMapUniforms` of the shadow maps.
    pub shadow_maps: Buffer,
    id: ViewId,
}

impl GpuView {
    /// The view's shadow maps for a frame that declares so many layers of them.
    ///
    /// # Errors
    /// When the view's maps are made for another number of layers.
    pub fn shadows(&self, declared: u16) -> Result<&ViewShadows, PassError> {
        let shadows = self.view.shadows.as_ref();
        let layers = shadows.map_or(0, |shadows| shadows.settings.layers());
        let fitting = shadows.filter(|_| layers == declared);
        fitting.ok_or(PassError::ShadowMaps { declared, view: self.id.0, layers })
    }
}

/// The views of a frame. Kept from frame to frame; [`Views::set`] replaces one.
#[derive(Debug, Default)]
pub struct Views(Vec<GpuView>);

impl Views {
    /// Uploads views; the first is [`ViewId::MAIN`].
    ///
    /// # Errors
    /// When the device refuses a buffer.
    pub fn new(gpu: &Gpu, views: impl IntoIterator<Item = CameraView>) -> Result<Self, DeviceError> {
        gpu.guard("buffers of views", || {
            let view = |(number, view): (u32, CameraView)| GpuView {
                objects: storage(gpu, "objects", bytemuck::cast_slice(&view.objects)),
                lights: storage(gpu, "lights", bytemuck::cast_slice(&view.lights)),
                light_lists: storage(gpu, "light lists", bytemuck::cast_slice(view.light_words())),
                shadow_maps: storage(gpu, "shadow maps", bytemuck::cast_slice(&view.shadow_map_uniforms())),
                view,
                id: ViewId(number),
            };
            Self((0..).zip(views).map(view).collect())
        })
    }

    /// Replaces a view. Its buffers are reused while they are large enough.
    ///
    /// # Errors
    /// When there is no such view.
    pub fn set(&mut self, gpu: &Gpu, id: ViewId, view: CameraView) -> Result<(), PassError> {
        let count = self.0.len();
        let own = self.0.get_mut(id.0 as usize).ok_or(PassError::NoView { view: id.0, count })?;
        refill(gpu, &mut own.objects, "objects", bytemuck::cast_slice(&view.objects));
        refill(gpu, &mut own.lights, "lights", bytemuck::cast_slice(&view.lights));
        refill(gpu, &mut own.light_lists, "light lists", bytemuck::cast_slice(view.light_words()));
        refill(gpu, &mut own.shadow_maps, "shadow maps", bytemuck::cast_slice(&view.shadow_map_uniforms()));
        own.view = view;
        Ok(())
    }

    /// The next frame of a view that stands still in a scene that does: seen after itself, through the places of its pixels
    /// that are `jitter_px` away from their middles. No buffer changes.
    ///
    /// # Errors
    /// When there is no such view.
    pub fn again(&mut self, id: ViewId, jitter_px: DVec2) -> Result<(), PassError> {
        let count = self.0.len();
        let own = self.0.get_mut(id.0 as usize).ok_or(PassError::NoView { view: id.0, count })?;
        own.view.earlier = Some(own.view.stand());
        own.view.still_frames = own.view.still_frames.saturating_add(1);
        own.view.jitter(jitter_px);
        Ok(())
    }

    /// The view of that number.
    ///
    /// # Errors
    /// When there is no such view.
    pub fn get(&self, id: ViewId) -> Result<&GpuView, PassError> {
        self.0.get(id.0 as usize).ok_or(PassError::NoView { view: id.0, count: self.0.len() })
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
