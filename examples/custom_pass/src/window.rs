//! Window mode: the graph draws into the images of the surface.

use crate::Failure;
use crate::args::Args;
use custom_pass::app::{App, Screen};
use custom_pass::engine::Engine;
use custom_pass::frame::Settings;
use framegraph::dump;
use framegraph_wgpu::{Gpu, SurfaceError, WindowSurface, describe};
use std::sync::Arc;
use std::time::Instant;
use wgpu::{Instance, InstanceDescriptor};
use winit::application::ApplicationHandler;
use winit::dpi::PhysicalSize;
use winit::event::{ElementState, KeyEvent, WindowEvent};
use winit::event_loop::{ActiveEventLoop, ControlFlow, EventLoop};
use winit::keyboard::{Key, NamedKey};
use winit::window::{Window, WindowId};

/// Opens a window and draws until it is closed.
///
/// # Errors
/// An input or device failure with a one-line message.
pub fn run(args: &Args) -> Result<(), Failure> {
    let no_display =
        |error| Failure::Input(format!("no window can be opened ({error}); write a file with --out FILE.png instead"));
    let events = EventLoop::new().map_err(no_display)?;
    events.set_control_flow(ControlFlow::Poll);
    let mut program = Program { args: args.clone(), running: None, failed: None };
    events.run_app(&mut program).map_err(Failure::device)?;
    program.failed.map_or(Ok(()), Err)
}

/// State of the event loop.
struct Program {
    args: Args,
    running: Option<Running>,
    failed: Option<Failure>,
}

/// Open window.
struct Running {
    window: Arc<Window>,
    instance: Instance,
    surface: WindowSurface,
    app: App,
    clock: Clock,
    drawn: u32,
    print_plan: bool,
}

/// Animation time, which can be paused.
struct Clock {
    since: Instant,
    before_s: f32,
    stopped: bool,
}

impl Clock {
    fn now_s(&self) -> f32 {
        self.before_s + if self.stopped { 0.0 } else { self.since.elapsed().as_secs_f32() }
    }

    fn toggle(&mut self) {
        self.before_s = self.now_s();
        self.since = Instant::now();
        self.stopped = !self.stopped;
    }
}

impl ApplicationHandler for Program {
    fn resumed(&mut self, events: &ActiveEventLoop) {
        if self.running.is_none() {
            match Running::open(events, &self.args) {
                Ok(running) => self.running = Some(running),
                Err(failure) => self.fail(events, failure),
            }
        }
    }

    fn window_event(&mut self, events: &ActiveEventLoop, _: WindowId, event: WindowEvent) {
        let Some(running) = &mut self.running else { return };
        let done = match event {
            WindowEvent::CloseRequested => {
                events.exit();
                Ok(())
            }
            WindowEvent::Resized(size) => {
                // The graph adopts the new size with the next frame.
                running.surface.resize([size.width, size.height]);
                Ok(())
            }
            WindowEvent::KeyboardInput { event, .. } => {
                running.key(events, &event);
                Ok(())
            }
            WindowEvent::RedrawRequested => running.draw(),
            _ => Ok(()),
        };
        let enough = self.args.frames.is_some_and(|frames| running.drawn >= frames);
        match done {
            Ok(()) if enough => events.exit(),
            Ok(()) => {}
            Err(failure) => self.fail(events, failure),
        }
    }

    fn about_to_wait(&mut self, _: &ActiveEventLoop) {
        if let Some(running) = &self.running {
            running.window.request_redraw();
        }
    }
}

impl Program {
    fn fail(&mut self, events: &ActiveEventLoop, failure: Failure) {
        self.failed = Some(failure);
        events.exit();
    }
}

impl Running {
    fn open(events: &ActiveEventLoop, args: &Args) -> Result<Self, Failure> {
        let [width, height] = args.size_px;
        let attributes = Window::default_attributes().with_inner_size(PhysicalSize::new(width, height));
        let window = Arc::new(events.create_window(attributes).map_err(Failure::device)?);
        let display = Box::new(events.owned_display_handle());
        let instance = Instance::new(InstanceDescriptor::new_with_display_handle_from_env(display));
        let surface = instance.create_surface(window.clone()).map_err(Failure::device)?;
        let engine = Engine::open(&instance, Some(&surface)).map_err(Failure::device)?;
        program::line(format_args!("adapter: {}", describe(&engine.adapter.get_info())));
        let size = window.inner_size();
        let gpu = Gpu::wrap(&engine.adapter, &engine.device, &engine.queue);
        let surface = WindowSurface::new(&gpu, surface, [size.width, size.height]).map_err(Failure::device)?;
        let app = App::new(engine, surface.format(), args.settings).map_err(Failure::device)?;
        let clock = Clock { since: Instant::now(), before_s: 0.0, stopped: false };
        let running = Self { window, instance, surface, app, clock, drawn: 0, print_plan: args.plan };
        running.show_title();
        Ok(running)
    }

    fn key(&mut self, events: &ActiveEventLoop, event: &KeyEvent) {
        if event.state != ElementState::Pressed || event.repeat {
            return;
        }
        let Settings { blur, outline } = self.app.settings;
        let settings = match event.logical_key.as_ref() {
            Key::Character("b" | "B") => Settings { blur: !blur, outline },
            Key::Character("o" | "O") => Settings { blur, outline: !outline },
            Key::Character("p" | "P") => {
                self.print_plan = true;
                return;
            }
            Key::Named(NamedKey::Space) => {
                self.clock.toggle();
                return;
            }
            Key::Named(NamedKey::Escape) => {
                events.exit();
                return;
            }
            _ => return,
        };
        self.app.settings = settings;
        self.show_title();
    }

    fn show_title(&self) {
        let Settings { blur, outline } = self.app.settings;
        let word = |on| if on { "on" } else { "off" };
        self.window.set_title(&format!("custom_pass: [B]lur {}, [O]utline {}, [P]lan", word(blur), word(outline)));
    }

    /// Draws into the next image of the surface, if available.
    fn draw(&mut self) -> Result<(), Failure> {
        let image = match self.surface.acquire() {
            Ok(Some(image)) => image,
            // The window is hidden or the screen is busy; the next redraw tries again.
            Ok(None) => return Ok(()),
            Err(SurfaceError::Lost) => {
                self.surface.replace(self.instance.create_surface(self.window.clone()).map_err(Failure::device)?);
                return Ok(());
            }
            Err(error) => return Err(Failure::device(error)),
        };
        self.app.draw(self.clock.now_s(), Screen::Surface(&image.texture)).map_err(Failure::device)?;
        if std::mem::take(&mut self.print_plan) {
            program::line(dump::text(self.app.frames.plan()));
            let flight = self.app.frames.frames_in_flight();
            if let Some(latency) = flight.latency() {
                let (median_ms, max) = (latency.median_ms, flight.max());
                program::line(format_args!("latency: median {median_ms:.2} ms with at most {max} frames queued"));
            }
        }
        self.window.pre_present_notify();
        self.surface.present(image);
        self.drawn += 1;
        Ok(())
    }
}
