//! Application with its graph: declared every frame, compiled after changes, executed.

use super::engine::Engine;
use super::frame::{Settings, declare};
use framegraph::Format;
use framegraph_wgpu::{FrameError, FrameLoop, Gpu, format_of};

/// Engine with its render graph.
#[derive(Debug)]
pub struct App {
    /// The engine, which recorders also receive as their world.
    pub engine: Engine,
    /// Graph state: frame, plan, pools, caches and times.
    pub frames: FrameLoop<Engine>,
    format: Format,
    /// Enabled effects.
    pub settings: Settings,
}

/// Error for a screen format that the graph does not support.
#[derive(Clone, PartialEq, Eq, thiserror::Error)]
#[error("screen: unsupported format {0:?}; use another surface format")]
pub struct UnknownFormat(wgpu::TextureFormat);

impl std::fmt::Debug for UnknownFormat {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Render target of a frame.
#[derive(Clone, Copy, Debug)]
pub enum Screen<'a> {
    /// Image of a surface, different in every frame.
    Surface(&'a wgpu::Texture),
    /// Persistent texture, whose views are cached.
    Texture(&'a wgpu::Texture),
}

impl App {
    /// Creates an application that draws into screens of `format`.
    ///
    /// # Errors
    /// [`UnknownFormat`].
    pub fn new(engine: Engine, format: wgpu::TextureFormat, settings: Settings) -> Result<Self, UnknownFormat> {
        let format = format_of(format).ok_or(UnknownFormat(format))?;
        // The engine keeps the device. The graph holds clones of its handles.
        let gpu = Gpu::wrap(&engine.adapter, &engine.device, &engine.queue);
        // Error handlers belong to the engine too. A device loss is forwarded, so that frames return an error.
        let errors = gpu.shared_errors();
        let heard = move |reason, message| errors.report_lost(format!("{reason:?}: {message}"));
        engine.device.set_device_lost_callback(heard);
        Ok(Self { frames: FrameLoop::new(&gpu), engine, format, settings })
    }

    /// Draws the frame at time `time_s` in seconds, at the size of `screen`.
    ///
    /// Changes are detected automatically: an unchanged frame is not compiled again. Unused textures stay in the pool for
    /// half a second, so switching an effect back creates nothing.
    ///
    /// # Errors
    /// An error of a pass, the compiler or the device. Nothing is drawn then, and the next frame starts clean.
    pub fn draw(&mut self, time_s: f32, screen: Screen<'_>) -> Result<(), FrameError> {
        let Self { engine, frames, format, settings } = self;
        let (Screen::Surface(image) | Screen::Texture(image)) = screen;
        let size = [image.width(), image.height()];
        engine.animate(time_s, size[0] as f32 / size[1] as f32);
        // Submissions of the engine to its own queue stay in order with the commands of the graph.
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
