//! The frame: the engine's drawing as one pass among others.

use super::blur::blur;
use super::compose::Compose;
use super::engine::{COLOR_FORMAT, DEPTH_FORMAT, Engine, ID_FORMAT};
use super::outline::Outline;
use framegraph::{ClearValue, DeclareError, Entry, Exit, Extent, Format, Intent, Texture, TextureDesc};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{RecordError, format_of};

/// What is switched on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// A glow: the scene, blurred, over itself.
    pub blur: bool,
    /// Lines around objects.
    pub outline: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self { blur: true, outline: true }
    }
}

/// Declares the frame; `screen` is the format of what it is drawn into. Returns the import that stands for it.
///
/// # Errors
/// What a pass refuses; a format that cannot be drawn into, say.
pub fn declare(frame: &mut Frame<Engine>, screen: Format, settings: Settings) -> Result<Texture, DeclareError> {
    // Somebody else's image: it holds nothing that we want, and what we draw must survive the frame. Which image it is
    // will be said when the frame is executed.
    let desc = TextureDesc::new(Extent::FRAME, screen);
    let screen = frame.graph_mut().import_texture("screen", desc, Entry::Undefined, Exit::Keep);

    // The engine's own pipelines, in a render pass that the graph opens. What the engine draws is declared; what becomes
    // of it is not: without the outline, ids and depth are never read, and will get no memory.
    let (color, ids, depth) = frame.add_fn(
        "scene",
        |pass| {
            let target = |format| TextureDesc::new(Extent::FRAME, format);
            let color = pass.texture("color", target(known(COLOR_FORMAT)));
            let ids = pass.texture("ids", target(known(ID_FORMAT)));
            let depth = pass.texture("depth", target(known(DEPTH_FORMAT)));
            // Pipelines that are made elsewhere fit these targets and no others: the step must not grow.
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

/// The graph's word for one of the engine's formats.
fn known(format: wgpu::TextureFormat) -> Format {
    match format_of(format) {
        Some(format) => format,
        None => unreachable!("the engine's formats are WebGPU's"),
    }
}
