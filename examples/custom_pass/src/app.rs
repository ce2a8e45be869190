//! The application with its graph: declared anew each frame, compiled when that or the size changes, executed.

use super::engine::Engine;
use super::frame::{Settings, declare};
use framegraph::Format;
use framegraph_wgpu::{FrameError, FrameLoop, Gpu, format_of};

/// The engine beside everything that the graph needs.
#[derive(Debug)]
pub struct App {
    /// The engine, which is also the world that recorders are handed.
    pub engine: Engine,
    /// The graph: its frame, plan, pools, caches, times.
    pub frames: FrameLoop<Engine>,
    format: Format,
    /// What is switched on.
    pub settings: Settings,
}

/// The screen has a format that the graph does not know.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("the screen's format {0:?} is unknown")]
pub struct UnknownFormat(wgpu::TextureFormat);

impl std::fmt::Debug for UnknownFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
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
    /// [`UnknownFormat`].
    pub fn new(engine: Engine, format: wgpu::TextureFormat, settings: Settings) -> Result<Self, UnknownFormat> {
        let format = format_of(format).ok_or(UnknownFormat(format))?;
        // The device stays the engine's: the graph only borrows it, in clones.
        let gpu = Gpu::wrap(&engine.adapter, &engine.device, &engine.queue);
        // So are its handlers; what ours hears of a loss, frames report as an error.
        let errors = gpu.shared_errors();
        let heard = move |reason, message| errors.report_lost(format!("{reason:?}: {message}"));
        engine.device.set_device_lost_callback(heard);
        Ok(Self { frames: FrameLoop::new(&gpu), engine, format, settings })
    }

    /// Draws the frame of time `time_s` in seconds. The screen says how large it is.
    ///
    /// Nothing is said of what changed since the last frame: one that is declared as before is not compiled again, and
    /// textures that are no longer used stay in the pool for half a second, so that switching back makes nothing.
    ///
    /// # Errors
    /// What a pass, the compiler or the device refuses. Nothing was drawn then, and the next frame starts clean.
    pub fn draw(&mut self, time_s: f32, screen: Screen<'_>) -> Result<(), FrameError> {
        let Self { engine, frames, format, settings } = self;
        let (Screen::Surface(image) | Screen::Texture(image)) = screen;
        let size = [image.width(), image.height()];
        engine.animate(time_s, size[0] as f32 / size[1] as f32);
        // Whatever the engine submits on its own queue before or after is in order with the graph's commands.
        frames.run(size, engine, |frame, imports| {
            let handle = declare(frame, *format, *settings)?;
            match screen {
                Screen::Surface(image) => imports.surface(handle, image),
                Screen::Texture(image) => imports.texture(handle, image),
            };
            Ok(())
        })?;
        Ok(())
    }
}
