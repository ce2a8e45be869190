//! egui over a frame in a window of winit, drawn with wgpu.

pub use egui_wgpu::wgpu;
pub use egui_winit::winit;

use egui::{Context, Ui, ViewportId};
use egui_wgpu::{Renderer, RendererOptions, ScreenDescriptor};
use wgpu::{CommandBuffer, Device, Queue, TextureFormat, TextureView};
use winit::event::WindowEvent;
use winit::window::Window;

/// An egui context with its input from a window and its renderer.
pub struct Overlay {
    state: egui_winit::State,
    renderer: Renderer,
}

impl Overlay {
    /// Creates an overlay for targets of one format.
    pub fn new(window: &Window, device: &Device, format: TextureFormat) -> Self {
        let ctx = Context::default();
        crate::panel::dress(&ctx);
        let (scale, side) = (window.scale_factor() as f32, device.limits().max_texture_dimension_2d as usize);
        let state = egui_winit::State::new(ctx, ViewportId::ROOT, window, Some(scale), window.theme(), Some(side));
        Self { state, renderer: Renderer::new(device, format, RendererOptions::default()) }
    }

    /// Returns the egui context.
    pub fn context(&self) -> &Context {
        self.state.egui_ctx()
    }

    /// Returns the renderer, which registers textures for [`Preview`](crate::Preview).
    pub fn renderer_mut(&mut self) -> &mut Renderer {
        &mut self.renderer
    }

    /// Passes an event of the window to egui. Returns true if egui consumed it, such as a click on a panel.
    pub fn event(&mut self, window: &Window, event: &WindowEvent) -> bool {
        self.state.on_window_event(window, event).consumed
    }

    /// Shows a UI and records its draws over the contents of `target`, a view of the first mip level.
    ///
    /// Submit the returned commands after those that draw the contents.
    pub fn draw(
        &mut self,
        window: &Window,
        (device, queue): (&Device, &Queue),
        target: &TextureView,
        show: impl FnMut(&mut Ui),
    ) -> CommandBuffer {
        let input = self.state.take_egui_input(window);
        let ctx = self.state.egui_ctx().clone();
        let mut output = ctx.run_ui(input, show);
        self.state.handle_platform_output(window, output.platform_output);
        let mut set: Vec<_> = output.textures_delta.set.drain().collect();
        set.sort_unstable_by_key(|(id, _)| *id);
        for (id, deltas) in set {
            for delta in deltas {
                self.renderer.update_texture(device, queue, id, &delta);
            }
        }
        let pixels_per_point = output.pixels_per_point;
        // The window may have another size already, and scissors must not exceed the target.
        let size = target.texture().size();
        let screen = ScreenDescriptor { size_in_pixels: [size.width, size.height], pixels_per_point };
        let jobs = ctx.tessellate(output.shapes, pixels_per_point);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("egui") });
        // Paint callbacks may record command buffers of their own, which run before the draws.
        let prepared = self.renderer.update_buffers(device, queue, &mut encoder, &jobs, &screen);
        if !prepared.is_empty() {
            queue.submit(prepared);
        }
        let attachment = wgpu::RenderPassColorAttachment {
            view: target,
            depth_slice: None,
            resolve_target: None,
            ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
        };
        let pass = wgpu::RenderPassDescriptor {
            label: Some("egui"),
            color_attachments: &[Some(attachment)],
            ..wgpu::RenderPassDescriptor::default()
        };
        let mut pass = encoder.begin_render_pass(&pass).forget_lifetime();
        self.renderer.render(&mut pass, &jobs, &screen);
        drop(pass);
        let mut free: Vec<_> = output.textures_delta.free.drain().collect();
        free.sort_unstable();
        for id in free {
            self.renderer.free_texture(&id);
        }
        encoder.finish()
    }
}
