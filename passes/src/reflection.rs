//! Reflections in what the picture shows.
//!
//! ```text
//! structure ───────────────────────┬─> reflection ─> reflection_level 1 ─> reflection_level 2 ─> … ─> color ─> hdr
//! reflection_depth ────────────────┤                                                                          │
//! hdr of the frame before ─────────┘ <────────────────────────────────────────────────────────────────────────┘
//! ```
//!
//! Surfaces are drawn once more, each pixel's mirrored ray is followed through the structure, and what it meets is taken from
//! the radiance of the frame before, which is kept for that: a history, no copy. Rough surfaces read a blurred level of the
//! result. Where rays found nothing, the color pass reflects the environment as without. `docs/reflections.md` has how far off
//! it is.

mod pass;
mod settings;

pub use pass::{Reflection, ReflectionIo};
pub use settings::ReflectionSettings;

use crate::prepass::Prepass;
use crate::program::Programs;
use crate::stages::{Handles, Slot, StageError};
use crate::structure::{Resolution, structure};
use crate::transmission::SceneLevel;
use crate::upload::GpuScene;
use crate::view::Views;
use framegraph::{Format, TextureDesc};
use framegraph_wgpu::Frame;

/// How many levels reflections in a picture of this size have: until they are as blurred as a surface a meter ahead of a usual
/// lens makes them at the roughness from which on nothing is traced, some eighth of the height.
#[must_use]
pub fn reflection_levels(picture_texels: [u32; 2]) -> u8 {
    let smaller = picture_texels[0].min(picture_texels[1]).max(1);
    (smaller.ilog2() as u8).saturating_sub(2).max(1)
}

/// Declares reflections of a view, the structure that they are followed through, and the history of its radiance, of `format`,
/// which the color pass is to draw into; hands on [`Slot::REFLECTIONS`] and [`Slot::HDR_HISTORY`].
///
/// # Errors
/// What a pass refuses; the history's name, `hdr`, when another view of the graph has it, which a scope of its own prevents.
pub fn reflections<W>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: &ReflectionSettings,
    (resolution, structure_levels): (Resolution, u8),
    levels: u8,
    format: Format,
) -> Result<(), StageError>
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized + 'static,
{
    let (view, extent) = (handles.view(), handles.extent());
    let structure = structure(frame, handles, resolution, structure_levels)?;
    let hdr = frame.graph_mut().history("hdr", TextureDesc::new(extent, format), 1);
    let earlier = frame.graph_mut().previous(hdr, 1)?;
    let depth = frame.add("reflection_depth", Prepass { view, extent, samples: 1 })?;
    let pass = Reflection { view, structure, depth, earlier, levels, settings: *settings };
    let mut reflections = frame.add("reflection", pass)?.reflections;
    for level in 1..levels {
        reflections = frame.add("reflection_level", SceneLevel { scene: reflections, level })?.scene;
    }
    handles.set(Slot::REFLECTIONS, reflections);
    handles.set(Slot::HDR_HISTORY, hdr);
    Ok(())
}
