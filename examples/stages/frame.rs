//! Standard frame with one additional and one replaced stage.

use crate::fog::Fog;
use crate::sharpen::Sharpen;
use framegraph_passes::effects::depth::resolve::{DepthOf, single_sample_depth};
use framegraph_passes::stages::Stages;
use framegraph_passes::{Settings, Slot, Stage, StageError, StandardWorld, stages};

/// Returns the standard frame with fog after the stage `color`, and a sharpening filter instead of `fxaa`.
///
/// # Errors
/// Fails only if the standard frame renames its stages.
pub fn foggy<W: StandardWorld + ?Sized>(settings: &Settings, density: f32) -> Result<Stages<W>, StageError> {
    // The replacement of FXAA reads its input: sRGB-encoded values.
    let mut stages = stages(&Settings { fxaa: true, ..*settings });
    stages.insert_after(
        "color",
        Stage::new("fog", move |frame, handles| {
            // With MSAA this declares a pass that resolves depth to one sample.
            let depth = single_sample_depth(frame, handles, DepthOf::Nearest)?;
            let fog =
                Fog { view: handles.view(), hdr: handles.get(Slot::HDR)?, depth, color: [0.7, 0.75, 0.8], density };
            let foggy = frame.add("fog", fog)?.foggy;
            // Later stages read the radiance with fog.
            handles.set(Slot::HDR, foggy);
            Ok(())
        }),
    )?;
    stages.replace(Stage::picture("fxaa", |frame, handles| {
        let sharpen = Sharpen { picture: handles.get(Slot::PICTURE)?, into: handles.target(), strength: 0.5 };
        let (_, sharp) = frame.add("sharpen", sharpen)?;
        handles.set(Slot::PICTURE, sharp);
        Ok(())
    }))?;
    Ok(stages)
}
