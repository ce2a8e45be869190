//! A window with a render graph: one pass draws a scene, and an effect reads its picture. `effect.wgsl` is reloaded when
//! it is saved.

use framegraph::{Entry, Exit, Extent, Format, Intent, TextureDesc};
use framegraph::{DeclareError, Pass, PassBuilder, Texture, View};
use framegraph_wgpu::wgpu::{Instance, InstanceDescriptor};
use framegraph_wgpu::{Cx, FrameLoop, Gpu, Raster, Record, RecordError, Shader, WindowSurface, format_of, wgpu};
use std::error::Error;
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

/// Draws the scene.
struct Scene;

impl Pass for Scene {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        let hdr = pass.texture("hdr", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
        pass.color(hdr, Intent::Overwrite)
    }
}

impl Record<World> for Scene {
    fn record(&self, _: &Texture, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let pipeline = cx.raster_pipeline(&Raster::new(SCENE))?;
        let time = cx.uniform(&[world.seconds; 4]);
        let group = cx.bind_group(pipeline.group(0), &[(0, time)]);
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
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
        let pipeline = cx.raster_pipeline(&Raster::new(EFFECT))?;
        let picture = cx.view(*picture)?;
        let group = cx.bind_group(pipeline.group(0), &[(0, picture.into())]);
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
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
        let (gpu, surface) = Gpu::open_for(&instance, instance.create_surface(window.clone())?)?;
        let size = window.inner_size();
        let surface = WindowSurface::new(&gpu, surface, [size.width, size.height])?;
        let frames = FrameLoop::new(&gpu);
        Ok(Self { window, surface, frames, started: Instant::now(), saved: saved() })
    }

    fn draw(&mut self) -> Result<(), Box<dyn Error>> {
        self.reload();
        // A hidden or minimized window has no image.
        let Some(image) = self.surface.acquire()? else { return Ok(()) };
        let format = format_of(self.surface.format()).ok_or("the window has an unknown format")?;
        let world = World { seconds: self.started.elapsed().as_secs_f32() };
        self.frames.run(self.surface.size(), &world, |frame, imports| {
            let desc = TextureDesc::new(Extent::FRAME, format);
            let target = frame.graph_mut().import_texture("window", desc, Entry::Undefined, Exit::Keep);
            imports.surface(target, &image.texture);
            let picture = frame.add("scene", Scene)?;
            frame.add("effect", Effect { picture, target })?;
            Ok::<_, DeclareError>(())
        })?;
        self.surface.present(image);
        Ok(())
    }

    /// Reloads the effect after it was saved. A broken shader is reported, and the previous one stays in use.
    fn reload(&mut self) {
        let saved = saved();
        if saved == self.saved {
            return;
        }
        self.saved = saved;
        if let Ok(text) = std::fs::read_to_string(EFFECT_FILE) {
            match self.frames.executor_mut().reload_shader(&EFFECT, &text) {
                Ok(_) => println!("{EFFECT_FILE}: reloaded"),
                Err(error) => eprintln!("{EFFECT_FILE}: {error}"),
            }
        }
    }
}

fn saved() -> Option<SystemTime> {
    std::fs::metadata(EFFECT_FILE).and_then(|file| file.modified()).ok()
}
