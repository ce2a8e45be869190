//! The panels over the picture of an engine: a window of winit, drawn with wgpu, without eframe.

mod frame;

use framegraph::Plan;
use framegraph_egui::PlanPanels;
use framegraph_egui::overlay::Overlay;
use framegraph_egui::overlay::wgpu::{self, CurrentSurfaceTexture};
use framegraph_egui::overlay::winit::application::ApplicationHandler;
use framegraph_egui::overlay::winit::event::WindowEvent;
use framegraph_egui::overlay::winit::event_loop::{ActiveEventLoop, EventLoop};
use framegraph_egui::overlay::winit::window::{Window, WindowId};
use std::error::Error;
use std::sync::Arc;

/// The engine, reduced to a background, and the panels over it.
struct Engine {
    window: Arc<Window>,
    surface: wgpu::Surface<'static>,
    device: wgpu::Device,
    queue: wgpu::Queue,
    config: wgpu::SurfaceConfiguration,
    overlay: Overlay,
    panels: PlanPanels,
    shadows: bool,
    plan: Plan,
}

impl Engine {
    fn open(events: &ActiveEventLoop) -> Result<Self, Box<dyn Error>> {
        let window = Arc::new(events.create_window(Window::default_attributes())?);
        let display = Box::new(events.owned_display_handle());
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle_from_env(display));
        let surface = instance.create_surface(window.clone())?;
        let options = wgpu::RequestAdapterOptions {
            compatible_surface: Some(&surface),
            ..wgpu::RequestAdapterOptions::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))?;
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default()))?;
        let [width, height] = <[u32; 2]>::from(window.inner_size()).map(|side| side.max(1));
        let config =
            surface.get_default_config(&adapter, width, height).ok_or("the adapter cannot draw to the window")?;
        surface.configure(&device, &config);
        let overlay = Overlay::new(&window, &device, config.format);
        let (panels, plan) = (PlanPanels::new(), frame::plan(true)?);
        Ok(Self { window, surface, device, queue, config, overlay, panels, shadows: true, plan })
    }

    fn resize(&mut self, size: [u32; 2]) {
        [self.config.width, self.config.height] = size.map(|side| side.max(1));
        self.surface.configure(&self.device, &self.config);
    }

    fn draw(&mut self) -> Result<(), Box<dyn Error>> {
        let image = match self.surface.get_current_texture() {
            CurrentSurfaceTexture::Success(image) | CurrentSurfaceTexture::Suboptimal(image) => image,
            // The next frame has an image again.
            _ => return Ok(()),
        };
        let view = image.texture.create_view(&wgpu::TextureViewDescriptor::default());
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color { r: 0.05, g: 0.1, b: 0.2, a: 1.0 }),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..wgpu::RenderPassDescriptor::default()
        }));
        let before = self.shadows;
        let commands = self.overlay.draw(&self.window, (&self.device, &self.queue), &view, |ui| {
            ui.checkbox(&mut self.shadows, "shadows");
            egui::Window::new("frame").default_size([1100.0, 560.0]).show(ui.ctx(), |ui| {
                self.panels.update(&self.plan);
                self.panels.show(ui);
            });
        });
        self.queue.submit([encoder.finish(), commands]);
        self.queue.present(image);
        if self.shadows != before {
            self.plan = frame::plan(self.shadows)?;
        }
        Ok(())
    }
}

#[derive(Default)]
struct Program {
    engine: Option<Engine>,
    failed: Option<Box<dyn Error>>,
}

impl ApplicationHandler for Program {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        self.engine = Engine::open(events).map_err(|error| self.failed = Some(error)).ok();
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(engine) = &mut self.engine else { return };
        engine.overlay.event(&engine.window, &event);
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) => engine.resize(size.into()),
            WindowEvent::RedrawRequested => self.failed = engine.draw().err(),
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        match &self.engine {
            Some(engine) if self.failed.is_none() => engine.window.request_redraw(),
            _ => events.exit(),
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut program = Program::default();
    EventLoop::new()?.run_app(&mut program)?;
    program.failed.map_or(Ok(()), Err)
}
