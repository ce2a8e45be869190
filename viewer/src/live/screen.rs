//! The device that frames and panels share, and where egui finds textures of it.

use eframe::egui_wgpu::{RenderState, Renderer};
use egui::TextureId;
use egui::mutex::RwLock;
use framegraph_wgpu::Gpu;
use std::sync::Arc;

/// The device that frames and panels share.
#[derive(Clone)]
pub struct Screen {
    /// The device.
    pub gpu: Gpu,
    /// Who draws the panels; none where nobody does, as in tests of panels without a picture.
    renderer: Option<Arc<RwLock<Renderer>>>,
}

impl Screen {
    /// The device that eframe opened for its window. What wgpu refuses outside of frames is told on the terminal.
    pub fn of(state: &RenderState) -> Self {
        let gpu = Gpu::wrap(&state.adapter, &state.device, &state.queue);
        state.device.on_uncaptured_error(Arc::new(|error| program::note(format_args!("the device refused: {error}"))));
        let lost = gpu.shared_errors();
        state
            .device
            .set_device_lost_callback(move |reason, message| lost.report_lost(format!("{reason:?}: {message}")));
        Self { gpu, renderer: Some(state.renderer.clone()) }
    }

    /// A device with who draws its panels.
    pub fn new(gpu: &Gpu, renderer: Option<Arc<RwLock<Renderer>>>) -> Self {
        Self { gpu: gpu.clone(), renderer }
    }

    /// What egui knows a texture by, instead of the one that it knew by `before`. Its texels are taken for display codes.
    pub fn show(&self, view: &wgpu::TextureView, before: Option<TextureId>) -> TextureId {
        let Some(renderer) = &self.renderer else { return before.unwrap_or(TextureId::User(0)) };
        let (device, filter) = (&self.gpu.device, wgpu::FilterMode::Linear);
        let mut renderer = renderer.write();
        match before {
            Some(id) => {
                renderer.update_egui_texture_from_wgpu_texture(device, view, filter, id);
                id
            }
            None => renderer.register_native_texture(device, view, filter),
        }
    }
}
