//! Temporal anti-aliasing: accumulates frames with different sub-pixel offsets.
//!
//! ```text
//! hdr ─────────────────────┬─> taa ─> accumulated hdr ─> sharpen (optional) ─> post
//! depth ───────────────────┤             │
//! previous accumulated hdr ┘ <───────────┘
//! ```
//!
//! Each frame is offset by a fraction of a pixel ([`CameraView::jitter`](crate::CameraView::jitter), by
//! [`TaaSettings::jitter_px`]). The pass reprojects each pixel into the history with its depth and both cameras. It
//! clamps the history to the colors around the pixel and blends in this frame. The history is not copied.
//! `docs/design/taa.md` has the errors.

mod jitter;
mod pass;
mod settings;
pub mod velocity;

pub use jitter::JitterPattern;
pub(crate) use pass::SUM_FORMAT;
pub use pass::{Taa, TaaIo};
pub use settings::{Clipping, ColorBox, TaaSettings};

use crate::effects::depth::resolve::{DepthOf, single_sample_depth};
use crate::effects::upscale::sharpen::Sharpen;
use crate::gpu_scene::view::Views;
use crate::program::Programs;
use crate::stages::{Handles, Slot, StageError};
use framegraph::{Target, TextureDesc};
use framegraph_wgpu::Frame;

/// Declares temporal anti-aliasing of a view; replaces [`Slot::HDR`].
///
/// # Errors
/// Returns the error of a refused pass. The history is named `taa`; a second view of the graph needs a scope of its
/// own.
pub fn temporal<W>(frame: &mut Frame<W>, handles: &mut Handles, settings: &TaaSettings) -> Result<(), StageError>
where
    W: AsRef<Programs> + AsRef<Views> + ?Sized,
{
    let depth = single_sample_depth(frame, handles, DepthOf::FirstSample)?;
    let hdr = handles.get(Slot::HDR)?;
    let sum = frame.graph_mut().history("taa", TextureDesc::new(handles.extent(), SUM_FORMAT), 1);
    let earlier = frame.graph_mut().previous(sum, 1)?;
    let velocity = handles.find(Slot::VELOCITY);
    let pass = Taa { view: handles.view(), hdr, depth, velocity, earlier, into: sum, settings: *settings };
    let mut hdr = frame.add("taa", pass)?.sum;
    if settings.sharpness > 0.0 {
        let pass = Sharpen { picture: hdr, into: Target::New, sharpness: settings.sharpness };
        hdr = frame.add("taa_sharpen", pass)?.sharp;
    }
    handles.set(Slot::HDR, hdr);
    Ok(())
}
