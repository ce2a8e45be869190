//! Screen-space reflections.
//!
//! ```text
//! structure ─> depth_bounds ─> … ──┬─> reflection ─> reflection_level 1 ─> reflection_level 2 ─> … ─> color ─> hdr
//! prepass ─────────────────────────┤                                                                          │
//! hdr of the previous frame ───────┘ <────────────────────────────────────────────────────────────────────────┘
//! ```
//!
//! Draws surfaces again, traces the reflected ray of each pixel through the structure, and reads radiance at the hit
//! from the previous frame. Rays skip blocks of texels that they pass in front of or behind. The previous radiance is a history, not a copy. Rough surfaces read coarser levels of the
//! result, selected by hit distance. The color pass reflects the environment where rays hit nothing.

mod bounds;
mod pass;
mod settings;

pub use bounds::{DepthBounds, DepthBoundsIo};
pub use pass::{Reflection, ReflectionIo};
pub use settings::ReflectionSettings;

use crate::effects::depth::prepass::Prepass;
use crate::effects::depth::structure::{Resolution, drawn_depth, structure};
use crate::effects::transmission::SceneLevel;
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::Views;
use crate::program::Programs;
use crate::stages::{Handles, Slot, StageError};
use framegraph::{Format, Target, TextureDesc};
use framegraph_wgpu::Frame;

/// Maximum number of levels of depth bounds; the largest blocks have 32×32 texels.
const MAX_BOUNDS_LEVELS: u8 = 5;

/// Declares screen-space reflections of a view, with the structure and a history of the radiance. The color pass has to
/// draw into that history, of format `format`. Sets [`Slot::REFLECTIONS`], [`Slot::HIT_DISTANCE`] and
/// [`Slot::HDR_HISTORY`].
///
/// # Errors
/// Returns the error of a refused pass. The history is named `hdr`; a second view of the graph needs a scope of its
/// own.
pub fn reflections<W>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: &ReflectionSettings,
    (resolution, structure_levels): (Resolution, u8),
    levels: u8,
    format: Format,
) -> Result<(), StageError>
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized,
{
    let (view, extent) = (handles.view(), handles.extent());
    let told = format_args!(
        "the settings ask for it: rays of {} m read the radiance of the previous frame, which is kept for them",
        settings.reach_m
    );
    frame.graph_mut().note("reflection", told);
    let structure = structure(frame, handles, resolution, structure_levels)?;
    let hdr = frame.graph_mut().history("hdr", TextureDesc::new(extent, format), 1);
    let earlier = frame.graph_mut().previous(hdr, 1)?;
    let depth = match drawn_depth(frame, handles) {
        Some(depth) => depth,
        None if resolution == Resolution::Full => structure,
        None => frame.add("reflection_depth", Prepass { view, extent, ..Prepass::default() })?,
    };
    let mut bounds = None;
    if settings.stride_texels <= 1.0 {
        // A picture of this many levels has one less at half its size.
        let levels = levels.saturating_sub(1).clamp(1, MAX_BOUNDS_LEVELS);
        for level in 0..levels {
            let target = bounds.map_or(Target::New, Target::from);
            let pass = DepthBounds { depth: structure, bounds: target, level, levels };
            bounds = Some(frame.add("depth_bounds", pass)?.bounds);
        }
    }
    let pass = Reflection { view, structure, bounds, depth, earlier, levels, settings: *settings };
    let ReflectionIo { mut reflections, ways, .. } = frame.add("reflection", pass)?;
    for level in 1..levels {
        reflections = frame.add("reflection_level", SceneLevel { scene: reflections, level })?.scene;
    }
    handles.set(Slot::REFLECTIONS, reflections);
    handles.set(Slot::HIT_DISTANCE, ways);
    handles.set(Slot::HDR_HISTORY, hdr);
    Ok(())
}
