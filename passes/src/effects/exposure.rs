//! Measures a frame: the range of its light and of its depth, for feature culling by values that only the GPU knows.
//!
//! ```text
//! hdr ───> light ─> smaller ─┐
//!                            ├─> Measuring (frames later, without waiting) ─> Measurement ─> facts::decide
//! depth ─> depth ─> smaller ─┘
//! ```
//!
//! Each pass reduces 8×8 texels to their maximum and minimum. The remaining texels, one per 4096 pixels, are copied to
//! the CPU, which reads them once they have arrived.

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

/// Declares the requested measurements; sets [`Slot::MEASURED_LIGHT`] and [`Slot::MEASURED_DEPTH`].
///
/// # Errors
/// Returns the error of a refused pass.
pub(crate) fn measure<W>(frame: &mut Frame<W>, handles: &mut Handles, measure: Measure) -> Result<(), StageError>
where
    W: AsRef<Programs> + ?Sized,
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

/// Declares a step, and one that reduces its result to an eighth of the width and height again.
fn smaller<W>(frame: &mut Frame<W>, handles: &Handles, first: MeasureStep) -> Result<Texture, StageError>
where
    W: AsRef<Programs> + ?Sized,
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
