//! Temporal anti-aliasing: what frames see through different places of their pixels is added up.
//!
//! ```text
//! hdr ─────────────────────┬─> taa ─> what frames come to ─> sharpen (where asked for) ─> post
//! depth ───────────────────┤             │
//! that of the frame before ┘ <───────────┘
//! ```
//!
//! Each frame moves its picture by a part of a pixel ([`CameraView::jitter`](crate::CameraView::jitter), by
//! [`TaaSettings::jitter_px`]). The pass finds each pixel in the sum of the frames before by its depth and both cameras, holds
//! what it finds there to the colors about the pixel now, and adds a share of this frame. The sum is a history: no copy.
//! `docs/taa.md` has how far off it is.

mod jitter;
mod pass;
mod settings;

pub use jitter::JitterPattern;
pub use pass::{Taa, TaaIo};
pub use settings::{Clipping, ColorBox, TaaSettings};

use crate::depth_resolve::{DepthOf, single_sample_depth};
use crate::program::Programs;
use crate::sharpen::Sharpen;
use crate::stages::{Handles, Slot, StageError};
use crate::view::Views;
use framegraph::{Target, TextureDesc};
use framegraph_wgpu::Frame;

/// Declares anti-aliasing of a view's radiance over time; hands on [`Slot::HDR`].
///
/// # Errors
/// What a pass refuses; the history's name, `taa`, when another view of the graph has it, which a scope of its own prevents.
pub fn temporal<W>(frame: &mut Frame<W>, handles: &mut Handles, settings: &TaaSettings) -> Result<(), StageError>
where
    W: AsRef<Programs> + AsRef<Views> + ?Sized + 'static,
{
    let depth = single_sample_depth(frame, handles, DepthOf::FirstSample)?;
    let hdr = handles.get(Slot::HDR)?;
    let sum = frame.graph_mut().history("taa", TextureDesc::new(handles.extent(), pass::SUM_FORMAT), 1);
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
