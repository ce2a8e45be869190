//! Depth of field: blurs everything nearer or farther than the focus distance, as a lens does.
//!
//! ```text
//! hdr ─┬─> coc ─┬─> level 1 ─> … ──────────┐
//! depth┘        └─> tiles ─> dilate ───────┼─> gather ─> median ─> combine ─> hdr
//! ```
//!
//! Alpha holds the radius of each texel's circle of confusion. Tiles know the radii that reach into them, so parts in
//! focus are skipped. The gather is Filament's, in fewer passes. `docs/design/lens.md` has its cost, and its error against
//! rays through a thin lens.

mod pass;
mod settings;

pub use pass::{DofIo, DofPass, DofStep};
pub use settings::{DofSettings, FILM_HEIGHT_M};

use crate::effects::depth::resolve::{DepthOf, single_sample_depth};
use crate::gpu_scene::view::Views;
use crate::program::Programs;
use crate::stages::{Handles, Slot, StageError};
use framegraph::Texture;
use framegraph_wgpu::Frame;

/// Maximum number of levels that taps read.
const MAX_LEVELS: u32 = 4;

/// Returns the number of levels for a picture of this size.
fn levels(settings: &DofSettings, size_texels: [u32; 2]) -> u8 {
    let least = size_texels[0].min(size_texels[1]) / settings.resolution.texel_px();
    (least.max(1).ilog2() + 1).min(MAX_LEVELS) as u8
}

/// Declares depth of field for a picture of `size_texels`; replaces [`Slot::HDR`].
///
/// # Errors
/// Returns the error of a refused pass.
pub fn depth_of_field<W>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: &DofSettings,
    size_texels: [u32; 2],
) -> Result<(), StageError>
where
    W: AsRef<Programs> + AsRef<Views> + ?Sized,
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
