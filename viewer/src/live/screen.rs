//! Device shared by frames and panels, and registration of textures with egui.

use eframe::egui_wgpu::{RenderState, Renderer};
use egui::TextureId;
use egui::mutex::RwLock;
use framegraph_wgpu::{AdapterRequest, Gpu, is_software};
use std::sync::Arc;

/// Device shared by frames and panels.
#[derive(Clone)]
pub struct Screen {
    /// Device.
    pub gpu: Gpu,
    /// Renderer of the panels; `None` in tests without pictures.
    renderer: Option<Arc<RwLock<Renderer>>>,
    /// The frame has a device of its own, and pictures are copied to the panels.
    pub apart: bool,
}

impl Screen {
    /// Wraps the device that eframe opened for its window. Uncaptured errors of wgpu are printed on standard error.
    ///
    /// A software driver draws one submission after the other, and compiles shaders in between. The frame gets another
    /// device there, so that the panels need not wait for it.
    pub fn of(state: &RenderState) -> Self {
        let info = state.adapter.get_info();
        if is_software(&info)
            && let Ok(gpu) = Gpu::open(&AdapterRequest { name: Some(info.name), ..AdapterRequest::from_env() })
        {
            return Self { gpu, renderer: None, apart: true };
        }
        let gpu = Gpu::wrap(&state.adapter, &state.device, &state.queue);
        state.device.on_uncaptured_error(Arc::new(|error| program::note(format_args!("device: {error}"))));
        let lost = gpu.shared_errors();
        state
            .device
            .set_device_lost_callback(move |reason, message| lost.report_lost(format!("{reason:?}: {message}")));
        Self { gpu, renderer: Some(state.renderer.clone()), apart: false }
    }

    /// Creates a screen from a device and an optional renderer of panels.
    pub fn new(gpu: &Gpu, renderer: Option<Arc<RwLock<Renderer>>>) -> Self {
        Self { gpu: gpu.clone(), renderer, apart: false }
    }

    /// Registers a texture with egui, replacing `before`. Its texels are display-encoded.
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
