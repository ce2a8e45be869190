//! Headless mode: draws into a texture and writes the last frame to a file.

use crate::Failure;
use crate::args::Args;
use custom_pass::app::{App, Screen};
use custom_pass::engine::Engine;
use framegraph::dump;
use framegraph_scene::picture::encode_png;
use framegraph_wgpu::{describe, read_texture};
use program::interrupt;
use program::outputs::{OutputError, Outputs};
use std::path::Path;
use wgpu::{Instance, InstanceDescriptor};

/// Seconds between two frames of the animation.
const STEP_S: f32 = 1.0 / 60.0;

/// Draws the frames and writes the last one to `out`.
///
/// # Errors
/// An input or device failure with a one-line message.
pub fn run(args: &Args, out: &Path) -> Result<(), Failure> {
    interrupt::watch();
    let output = |error: OutputError| Failure::Input(format!("--out {error}"));
    let mut outputs = Outputs::default();
    outputs.add(out).map_err(output)?;
    let instance = Instance::new(InstanceDescriptor::new_without_display_handle_from_env());
    let engine = Engine::open(&instance, None).map_err(Failure::device)?;
    program::line(format_args!("adapter: {}", describe(&engine.adapter.get_info())));
    let [width, height] = args.size_px;
    let max = engine.device.limits().max_texture_dimension_2d;
    if width.max(height) > max {
        return Err(Failure::Input(format!("--size {width}x{height}: exceeds the adapter's limit of {max}x{max}")));
    }
    let image = engine.picture(args.size_px);
    let mut app = App::new(engine, image.format(), args.settings).map_err(Failure::device)?;
    for frame in 0..args.frames.unwrap_or(1) {
        app.draw(frame as f32 * STEP_S, Screen::Texture(&image)).map_err(Failure::device)?;
        app.frames.executor().gpu().wait().map_err(Failure::device)?;
        interrupt::check().map_err(Failure::device)?;
    }
    if args.plan {
        program::line(dump::text(app.frames.plan()));
    }
    let pixels = read_texture(app.frames.executor().gpu(), &image).map_err(Failure::device)?;
    outputs.write(out, |file| encode_png(file, pixels.texels, &pixels.rgba8())).map_err(output)?;
    outputs.commit().map_err(output)?;
    program::line(format_args!("wrote {}", out.display()));
    Ok(())
}
