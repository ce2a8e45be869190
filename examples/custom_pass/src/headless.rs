//! Without a window: a texture of our own takes the screen's place, and its last frame becomes a file.

use crate::Failure;
use crate::args::Args;
use custom_pass::app::{App, Screen};
use custom_pass::engine::Engine;
use framegraph::dump;
use framegraph_scene::picture::write_png;
use framegraph_wgpu::{describe, read_texture};
use std::path::Path;
use wgpu::{Instance, InstanceDescriptor};

/// Seconds between two frames of the animation.
const STEP_S: f32 = 1.0 / 60.0;

/// Draws the frames that `args` asks for and writes the last one.
///
/// # Errors
/// Whose fault it is, in one line.
pub fn run(args: &Args, out: &Path) -> Result<(), Failure> {
    let folder = out.parent().filter(|folder| !folder.as_os_str().is_empty());
    if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
        return Err(Failure::Input(format!("--out {}: there is no folder {}", out.display(), folder.display())));
    }
    let instance = Instance::new(InstanceDescriptor::new_without_display_handle_from_env());
    let engine = Engine::open(&instance, None).map_err(Failure::device)?;
    println!("adapter: {}", describe(&engine.adapter.get_info()));
    let [width, height] = args.size_px;
    let most = engine.device.limits().max_texture_dimension_2d;
    if width.max(height) > most {
        return Err(Failure::Input(format!("--size {width}x{height}: the adapter's limit is {most}x{most}")));
    }
    let image = engine.picture(args.size_px);
    let mut app = App::new(engine, image.format(), args.settings).map_err(Failure::device)?;
    for frame in 0..args.frames.unwrap_or(1) {
        app.draw(frame as f32 * STEP_S, Screen::Texture(&image)).map_err(Failure::device)?;
        app.frames.executor().gpu().wait().map_err(Failure::device)?;
    }
    if args.plan {
        println!("{}", dump::text(app.frames.plan()));
    }
    let pixels = read_texture(app.frames.executor().gpu(), &image).map_err(Failure::device)?;
    write_png(out, pixels.texels, &pixels.rgba8()).map_err(|error| Failure::Input(error.to_string()))?;
    println!("wrote {}", out.display());
    Ok(())
}
