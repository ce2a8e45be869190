//! A window with a render graph: a scene, and an effect that reads its picture and is reloaded when it is saved.

use framegraph::{DeclareError, Entry, Exit, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_wgpu::wgpu::{Instance, InstanceDescriptor};
use framegraph_wgpu::{Binding, Cx, FrameLoop, Gpu, Raster, Record, RecordError, Shader, WindowSurface, format_of};
use std::error::Error;
use std::io::Write as _;
use std::sync::Arc;
use std::time::{Instant, SystemTime};
use winit::application::ApplicationHandler;
use winit::event::WindowEvent;
use winit::event_loop::{ActiveEventLoop, EventLoop};
use winit::window::{Window, WindowId};

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
    started: Instant,
    saved: Option<SystemTime>,
}

impl App {
    fn open(events: &ActiveEventLoop) -> Result<Self, Box<dyn Error>> {
        let window = Arc::new(events.create_window(Window::default_attributes())?);
        let display = Box::new(events.owned_display_handle());
        let instance = Instance::new(InstanceDescriptor::new_with_display_handle_from_env(display));
        let surface = instance.create_surface(window.clone())?;
        let gpu = pollster::block_on(Gpu::request(&instance, Some(&surface)))?;
        let surface = WindowSurface::new(&gpu, surface, window.inner_size().into())?;
        Ok(Self { window, surface, frames: FrameLoop::new(&gpu), started: Instant::now(), saved: None })
    }

    fn draw(&mut self) -> Result<(), Box<dyn Error>> {
        self.reload();
        // A hidden or minimized window has no image.
        let Some(image) = self.surface.acquire()? else { return Ok(()) };
        let format = format_of(self.surface.format()).ok_or("the window has an unknown format")?;
        let [desc, hdr] = [format, Format::Rgba16Float].map(|format| TextureDesc::new(Extent::FRAME, format));
        let world = World { seconds: self.started.elapsed().as_secs_f32() };
        self.frames.run(self.surface.size(), &world, |frame, imports| {
            let target = frame.graph_mut().import_texture("window", desc, Entry::Undefined, Exit::Keep);
            imports.surface(target, &image.texture);
            let hdr = frame.graph_mut().texture("hdr", hdr);
            // A short pass is a pair of closures: what it accesses, and what it records.
            let picture = frame.add_fn(
                "scene",
                |pass| pass.color(hdr, Intent::Overwrite),
                |_, world: &World, cx| {
                    let seconds = cx.uniform(&[world.seconds; 4]);
                    triangle(cx, SCENE, seconds)
                },
            )?;
            frame.add("effect", Effect { picture, target })?;
            Ok::<_, DeclareError>(())
        })?;
        self.surface.present(image);
        Ok(())
    }

    /// Reloads the effect after it was saved. A broken shader is reported, and the previous one stays in use.
    fn reload(&mut self) {
        let saved = std::fs::metadata(EFFECT_FILE).and_then(|file| file.modified()).ok();
        if saved != self.saved
            && let Ok(text) = std::fs::read_to_string(EFFECT_FILE)
            && let Err(error) = self.frames.executor_mut().reload_shader(&EFFECT, &text)
        {
            let _ = writeln!(std::io::stderr(), "{EFFECT_FILE}: {error}");
        }
        self.saved = saved;
    }
}

#[derive(Default)]
struct Program {
    app: Option<App>,
    failed: Option<Box<dyn Error>>,
}

impl ApplicationHandler for Program {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        self.app = App::open(events).map_err(|error| self.failed = Some(error)).ok();
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(app) = &mut self.app else { return };
        match event {
            WindowEvent::CloseRequested => events.exit(),
            WindowEvent::Resized(size) => app.surface.resize(size.into()),
            WindowEvent::RedrawRequested => self.failed = app.draw().err(),
            _ => {}
        }
    }

    fn about_to_wait(&mut self, events: &ActiveEventLoop) {
        if self.failed.is_some() {
            events.exit();
        } else if let Some(app) = &self.app {
            app.window.request_redraw();
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut program = Program::default();
    EventLoop::new()?.run_app(&mut program)?;
    program.failed.map_or(Ok(()), Err)
}
