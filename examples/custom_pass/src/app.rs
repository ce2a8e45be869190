//! The application with its graph: declared when an effect is switched, compiled when that or the size changes, executed
//! every frame.

use super::engine::Engine;
use super::frame::{Settings, declare};
use framegraph::{CompileErrors, DeclareError, Format, Options, Plan, Scratch, Texture, recompile};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{ExecuteError, Executor, Gpu, Imports, format_of};

/// The engine beside everything that the graph needs.
#[derive(Debug)]
pub struct App {
    /// The engine, which is also the world that recorders are handed.
    pub engine: Engine,
    /// Pools, caches, times.
    pub executor: Executor,
    /// Passes and their recorders.
    pub frame: Frame<Engine>,
    /// What the compiler made of them.
    pub plan: Plan,
    /// What stands for the screen.
    pub imports: Imports,
    screen: Texture,
    format: Format,
    settings: Settings,
    options: Options,
    scratch: Scratch,
    stale: bool,
}

/// A frame could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum AppError {
    /// The screen has a format that the graph does not know.
    #[error("the screen's format {0:?} is unknown")]
    Format(wgpu::TextureFormat),
    /// A pass was refused.
    #[error(transparent)]
    Declare(#[from] DeclareError),
    /// The frame was refused.
    #[error(transparent)]
    Compile(#[from] CompileErrors),
    /// The device failed, or a recorder.
    #[error(transparent)]
    Execute(#[from] ExecuteError),
}

/// What a frame is drawn into.
#[derive(Clone, Copy, Debug)]
pub enum Screen<'a> {
    /// The image of a surface: another one each time.
    Surface(&'a wgpu::Texture),
    /// A texture of one's own: views of it are kept.
    Texture(&'a wgpu::Texture),
}

impl App {
    /// An application that draws into screens of that format.
    ///
    /// # Errors
    /// [`AppError`].
    pub fn new(engine: Engine, format: wgpu::TextureFormat, settings: Settings) -> Result<Self, AppError> {
        let format = format_of(format).ok_or(AppError::Format(format))?;
        // The device stays the engine's: the executor only borrows it, in clones.
        let gpu = Gpu::wrap(&engine.adapter, &engine.device, &engine.queue);
        // So are its handlers; what ours hears of a loss, frames report as an error.
        let errors = gpu.shared_errors();
        let heard = move |reason, message| errors.report_lost(format!("{reason:?}: {message}"));
        engine.device.set_device_lost_callback(heard);
        let mut frame = Frame::new();
        let screen = declare(&mut frame, format, settings)?;
        Ok(Self {
            executor: Executor::new(&gpu),
            engine,
            frame,
            plan: Plan::new(),
            imports: Imports::new(),
            screen,
            format,
            settings,
            options: Options::for_frame(1, 1),
            scratch: Scratch::new(),
            stale: true,
        })
    }

    /// What is switched on.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// Switches effects. The frame is declared anew; textures that are no longer used stay in the pool for half a second,
    /// so switching back makes nothing.
    ///
    /// # Errors
    /// What a pass refuses.
    pub fn switch(&mut self, settings: Settings) -> Result<(), AppError> {
        if settings != self.settings {
            self.frame.reset();
            // Handles of before are stale from here on.
            self.screen = declare(&mut self.frame, self.format, settings)?;
            (self.settings, self.stale) = (settings, true);
        }
        Ok(())
    }

    /// Draws the frame of time `time_s` in seconds. The screen says how large it is.
    ///
    /// # Errors
    /// [`AppError`]. Nothing was drawn then, and the next frame starts clean.
    pub fn draw(&mut self, time_s: f32, screen: Screen<'_>) -> Result<(), AppError> {
        let (Screen::Surface(image) | Screen::Texture(image)) = screen;
        let size = [image.width(), image.height()];
        if self.stale || self.options.frame != size {
            self.options.frame = size;
            let caps = self.executor.gpu().caps();
            recompile(self.frame.graph(), &caps, &self.options, &mut self.scratch, &mut self.plan)?;
            self.stale = false;
        }
        self.imports.clear();
        match screen {
            Screen::Surface(image) => self.imports.surface(self.screen, image),
            Screen::Texture(image) => self.imports.texture(self.screen, image),
        };
        self.engine.animate(time_s, size[0] as f32 / size[1] as f32);
        // Whatever the engine submits on its own queue before or after is in order with the graph's commands.
        self.executor.execute(&self.plan, &self.frame, &self.engine, &self.imports)?;
        Ok(())
    }
}
