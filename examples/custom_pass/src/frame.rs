//! The frame: the drawing of the engine as one pass among others.

use super::blur::blur;
use super::compose::Compose;
use super::engine::{COLOR_FORMAT, DEPTH_FORMAT, Engine, ID_FORMAT};
use super::outline::Outline;
use framegraph::{ClearValue, DeclareError, Entry, Exit, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{RecordError, format_of};

/// Enabled effects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Glow: the blurred scene on top of the scene.
    pub blur: bool,
    /// Lines around objects.
    pub outline: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { blur: true, outline: true }
    }
}

/// Declares the frame and returns the import of the screen, whose format is `screen`.
///
/// # Errors
/// An error of a pass, such as a format that is not renderable.
pub fn declare(frame: &mut Frame<Engine>, screen: Format, settings: Settings) -> Result<Texture, DeclareError> {
    // The screen is an external image. Its contents are not needed, and the result must survive the frame. The image itself
    // is bound at execution.
    let desc = TextureDesc::new(Extent::FRAME, screen);
    let screen = frame.graph_mut().import_texture("screen", desc, Entry::Undefined, Exit::Keep);

    // The pipelines of the engine draw in a render pass of the graph. The graph decides whether outputs are stored: without
    // outlines, ids and depth are never read and get no memory.
    let (color, ids, depth) = frame.add_fn(
        "scene",
        |pass| {
            let target = |format| TextureDesc::new(Extent::FRAME, format);
            let color = pass.texture("color", target(known(COLOR_FORMAT)));
            let ids = pass.texture("ids", target(known(ID_FORMAT)));
            let depth = pass.texture("depth", target(known(DEPTH_FORMAT)));
            // External pipelines match exactly these targets, so the step must not gain attachments.
            pass.never_merge();
            Ok((
                pass.color(color, Intent::Overwrite)?,
                pass.color(ids, Intent::Overwrite)?,
                pass.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED))?,
            ))
        },
        |_, engine: &Engine, cx| {
            engine.draw(cx.render_pass()?);
            Ok::<(), RecordError>(())
        },
    )?;

    let glow = if settings.blur { Some(blur(frame, color)?) } else { None };
    let picture = frame.add("compose", Compose { image: color, glow, into: screen })?.picture;
    if settings.outline {
        frame.add("outline", Outline { ids, depth, over: picture })?;
    }
    Ok(screen)
}

/// Returns the graph's format for one of the engine's formats.
fn known(format: wgpu::TextureFormat) -> Format {
    match format_of(format) {
        Some(format) => format,
        None => unreachable!("the engine's formats are WebGPU's"),
    }
}
