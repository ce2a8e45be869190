//! Measuring a frame: how bright its light is, and how near and far what it shows; for facts that only the GPU knows.
//!
//! ```text
//! hdr ───> light ─> smaller ─┐
//!                            ├─> Measuring (frames later, without waiting) ─> Measurement ─> facts::decide
//! depth ─> depth ─> smaller ─┘
//! ```
//!
//! Each pass takes eight by eight texels to their most and their least; what is left, a texel for 4096 of the picture, is
//! copied to the CPU, which looks at it when it has come.

mod pass;
mod readback;
mod wanted;

pub use pass::{MeasureIo, MeasurePass, MeasureStep};
pub use readback::{MeasureCounts, Measured, Measurement, Measuring};
pub use wanted::{Measure, MeasuredTextures};

use crate::effects::depth::resolve::{DepthOf, single_sample_depth};
use crate::program::Programs;
use crate::stages::{Handles, Slot, StageError};
use framegraph::Texture;
use framegraph_wgpu::Frame;

/// Declares what is to be measured; hands on [`Slot::MEASURED_LIGHT`] and [`Slot::MEASURED_DEPTH`].
///
/// # Errors
/// What a pass refuses.
pub(crate) fn measure<W>(frame: &mut Frame<W>, handles: &mut Handles, measure: Measure) -> Result<(), StageError>
where
    W: AsRef<Programs> + ?Sized + 'static,
{
    if measure.light {
        let light = smaller(frame, handles, MeasureStep::Light { hdr: handles.get(Slot::HDR)? })?;
        handles.set(Slot::MEASURED_LIGHT, light);
    }
    if measure.depth {
        let depth = single_sample_depth(frame, handles, DepthOf::FirstSample)?;
        let depth = smaller(frame, handles, MeasureStep::Depth { depth })?;
        handles.set(Slot::MEASURED_DEPTH, depth);
    }
    Ok(())
}

/// The step, and one that makes its result an eighth as wide and high again.
fn smaller<W>(frame: &mut Frame<W>, handles: &Handles, first: MeasureStep) -> Result<Texture, StageError>
where
    W: AsRef<Programs> + ?Sized + 'static,
{
    let extent = handles.extent();
    let small = frame.scope("measure", |frame| {
        let measured = frame.add(first.name(), MeasurePass { step: first, extent, eighths: 1 })?.result;
        let step = MeasureStep::Smaller { measured };
        Ok::<Texture, StageError>(frame.add(step.name(), MeasurePass { step, extent, eighths: 2 })?.result)
    })?;
    frame.graph_mut().readback(small)?;
    Ok(small)
}
