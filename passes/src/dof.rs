//! Depth of field: what is nearer or farther than what is in focus is blurred as a lens does.
//!
//! ```text
//! hdr ─┬─> coc ─┬─> level 1 ─> … ──────────┐
//! depth┘        └─> tiles ─> dilate ───────┼─> gather ─> median ─> combine ─> hdr
//! ```
//!
//! The radius of each texel's circle of confusion goes beside its radiance, in alpha; tiles know the radii that reach into them,
//! so that what is in focus is skipped. Filament's gather, in fewer passes; `docs/lens.md` has what it costs and how far off it
//! is from rays through a thin lens.

mod keys;
mod pass;
mod settings;

pub use pass::{DofIo, DofPass, DofStep};
pub use settings::{DofSettings, FILM_HEIGHT_M};

use crate::depth_resolve::{DepthOf, single_sample_depth};
use crate::program::Programs;
use crate::stages::{Handles, Slot, StageError};
use crate::view::Views;
use framegraph::Texture;
use framegraph_wgpu::Frame;

/// The most levels that taps read.
const MOST_LEVELS: u32 = 4;

/// How many levels the gather of a picture of this size reads.
fn levels(settings: &DofSettings, size_texels: [u32; 2]) -> u8 {
    let least = size_texels[0].min(size_texels[1]) / settings.resolution.texel_px();
    (least.max(1).ilog2() + 1).min(MOST_LEVELS) as u8
}

/// Declares depth of field of a picture of `size_texels`; hands on [`Slot::HDR`] anew.
///
/// # Errors
/// What a pass refuses.
pub fn depth_of_field<W>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: &DofSettings,
    size_texels: [u32; 2],
) -> Result<(), StageError>
where
    W: AsRef<Programs> + AsRef<Views> + ?Sized + 'static,
{
    let depth = single_sample_depth(frame, handles, DepthOf::FirstSample)?;
    let (view, hdr, extent) = (handles.view(), handles.get(Slot::HDR)?, handles.extent());
    let levels = levels(settings, size_texels);
    let combined = frame.scope("dof", |frame| {
        let mut add = |step: DofStep| {
            let pass = DofPass { view, step, extent, levels, settings: *settings };
            Ok::<Texture, StageError>(frame.add(step.name(), pass)?.result)
        };
        let mut field = add(DofStep::Coc { hdr, depth })?;
        for level in 1..levels {
            field = add(DofStep::Level { field, level })?;
        }
        let tiles = add(DofStep::Tiles { field })?;
        let tiles = add(DofStep::Dilate { tiles })?;
        let mut gathered = add(DofStep::Gather { field, tiles })?;
        if settings.median {
            gathered = add(DofStep::Median { gathered, tiles })?;
        }
        add(DofStep::Combine { hdr, gathered })
    })?;
    handles.set(Slot::HDR, combined);
    Ok(())
}
