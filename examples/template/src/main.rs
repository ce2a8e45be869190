//! A window with a render graph: a scene, an effect that is reloaded when it is saved, and panels that show the graph's plan.

use framegraph::{DeclareError, Entry, Exit, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_egui::overlay::winit::event_loop::{ActiveEventLoop, EventLoop};
use framegraph_egui::overlay::winit::window::{Window, WindowId};
use framegraph_egui::overlay::winit::{application::ApplicationHandler, event::WindowEvent};
use framegraph_egui::{PlanPanels, overlay::Overlay, overlay::wgpu};
use framegraph_wgpu::{Binding, Cx, Frame, FrameCommands, FrameLoop, Gpu, Imports, Raster};
use framegraph_wgpu::{Record, RecordError, Shader, WindowSurface, format_of};
use std::{error::Error, io::Write as _, sync::Arc, time::SystemTime};

const SCENE: Shader<'static> = Shader::new("scene", include_str!("scene.wgsl"));
const EFFECT: Shader<'static> = Shader::new("effect", include_str!("effect.wgsl"));
const EFFECT_FILE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/src/effect.wgsl");

/// Data that every recorder reads: put your scene here.
struct World {
    seconds: f32,
}

/// Your effect: reads `picture` and writes `target`.
struct Effect {
    picture: Texture,
    target: Texture,
}

impl Pass for Effect {
    type Io = View;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<View, DeclareError> {
        pass.color(self.target, Intent::Overwrite)?;
        pass.sampled(self.picture)
    }
}

impl Record<World> for Effect {
    fn record(&self, picture: &View, _: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let picture = cx.view(*picture)?.into();
        triangle(cx, EFFECT, picture)
    }
}

/// Draws a triangle that covers the target, with `input` at binding 0.
fn triangle(cx: &mut Cx<'_>, shader: Shader<'static>, input: Binding) -> Result<(), RecordError> {
    let pipeline = cx.raster_pipeline(&Raster::new(shader))?;
    let group = cx.bind_group(pipeline.group(0), &[(0, input)]);
    let pass = cx.render_pass()?;
    pass.set_pipeline(&pipeline);
    pass.set_bind_group(0, &group, &[]);
    pass.draw(0..3, 0..1);
    Ok(())
}

struct App {
    window: Arc<Window>,
    surface: WindowSurface,
    frames: FrameLoop<World>,
    gpu: Gpu,
    overlay: Overlay,
    panels: PlanPanels,
    saved: Option<SystemTime>,
}

impl App {
    fn open(events: &ActiveEventLoop) -> Result<Self, Box<dyn Error>> {
        let window = Arc::new(events.create_window(Window::default_attributes())?);
        let display = Box::new(events.owned_display_handle());
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_with_display_handle_from_env(display));
        let surface = instance.create_surface(window.clone())?;
        let gpu = pollster::block_on(Gpu::request(&instance, Some(&surface)))?;
        let surface = WindowSurface::new(&gpu, surface, window.inner_size().into())?;
        let overlay = Overlay::new(&window, &gpu.device, surface.format());
        let frames = FrameLoop::new(&gpu);
        Ok(Self { window, surface, frames, gpu, overlay, panels: PlanPanels::new(), saved: None })
    }

    fn draw(&mut self) -> Result<(), Box<dyn Error>> {
        self.reload();
        // A hidden or minimized window has no image.
        let Some(image) = self.surface.acquire()? else { return Ok(()) };
        let format = format_of(self.surface.format()).ok_or("the window has an unknown format")?;
        let [desc, hdr] = [format, Format::Rgba16Float].map(|format| TextureDesc::new(Extent::FRAME, format));
        let view = image.texture.create_view(&wgpu::TextureViewDescriptor::default());
        self.panels.update(self.frames.plan());
        let queue = &self.gpu.queue;
        let interface = self.overlay.draw(&self.window, (&self.gpu.device, queue), &view, |ui| {
            egui::Window::new("frame").default_size([900.0, 420.0]).show(ui.ctx(), |ui| self.panels.show(ui));
        });
        let world = World { seconds: self.overlay.context().time() as f32 };
        let declare = |frame: &mut Frame<World>, imports: &mut Imports| {
            let target = frame.graph_mut().import_texture("window", desc, Entry::Undefined, Exit::Keep);
            imports.surface(target, &image.texture);
            let hdr = frame.graph_mut().texture("hdr", hdr);
            // A short pass is a pair of closures: what it accesses, and what it records.
            let writes = |pass: &mut PassBuilder<'_>| pass.color(hdr, Intent::Overwrite);
            let picture = frame.add_fn("scene", writes, |_, world: &World, cx| {
                let seconds = cx.uniform(&[world.seconds; 4]);
                triangle(cx, SCENE, seconds)
            })?;
            frame.add("effect", Effect { picture, target })?;
            Ok::<_, DeclareError>(())
        };
        let submit = |commands: FrameCommands| commands.submit(queue, [], [interface]);
        self.frames.run_with(self.surface.size(), &world, declare, submit)?;
        self.surface.present(image);
        Ok(())
    }

    /// Reloads the effect after it was saved. A broken shader is reported, and the previous one stays in use.
    fn reload(&mut self) {
        let saved = std::fs::metadata(EFFECT_FILE).and_then(|f| f.modified()).ok();
        if std::mem::replace(&mut self.saved, saved) != saved
            && let Ok(text) = std::fs::read_to_string(EFFECT_FILE)
            && let Err(error) = self.frames.executor_mut().reload_shader(&EFFECT, &text)
        {
            let _ = writeln!(std::io::stderr(), "{EFFECT_FILE}: {error}");
        }
    }
}

#[derive(Default)]
struct Program(Option<App>, Option<Box<dyn Error>>);

impl ApplicationHandler for Program {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        self.0 = App::open(events).map_err(|error| self.1 = Some(error)).ok();
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(app) = &mut self.0 else { return };
        app.overlay.event(&app.window, &event);
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) => app.surface.resize(size.into()),
            WindowEvent::RedrawRequested => self.1 = app.draw().err(),
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        let Some(app) = self.0.as_ref().filter(|_| self.1.is_none()) else { return events.exit() };
        app.window.request_redraw();
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut program = Program::default();
    EventLoop::new()?.run_app(&mut program)?;
    program.1.map_or(Ok(()), Err)
}
