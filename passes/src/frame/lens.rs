//! Stages of lens effects: depth of field, bloom, lens flare.

use crate::effects::bloom;
use crate::effects::bloom::{BloomChain, BloomMix, BloomSettings};
use crate::effects::dof::{DofSettings, depth_of_field};
use crate::gpu_scene::view::Views;
use crate::program::Programs;
use crate::stages::{Handles, Slot, StageError};
use framegraph_wgpu::Frame;

pub(super) fn dof<W: AsRef<Programs> + AsRef<Views> + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: Option<DofSettings>,
    size_texels: [u32; 2],
) -> Result<(), StageError> {
    match settings.filter(DofSettings::is_seen) {
        Some(own) => depth_of_field(frame, handles, &own, size_texels),
        None => Ok(()),
    }
}

/// Declares bloom, unless a stage has already provided it. With TAA, bloom does not weight bright pixels against
/// flicker.
pub(super) fn bloom<W: AsRef<Programs> + AsRef<Views> + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: Option<BloomSettings>,
    (size_texels, over_time): ([u32; 2], bool),
) -> Result<(), StageError> {
    match settings.filter(BloomSettings::is_seen) {
        Some(own) if handles.find(Slot::BLOOM).is_none() => {
            let own = BloomSettings { fireflies: own.fireflies && !over_time, ..own };
            bloom::bloom(frame, handles, &own, size_texels)
        }
        _ => Ok(()),
    }
}

/// Returns the bloom as post-processing reads it.
pub(super) fn mix_of(handles: &Handles, settings: Option<BloomSettings>, size_texels: [u32; 2]) -> Option<BloomMix> {
    let own = settings.filter(BloomSettings::is_seen)?;
    Some(BloomMix {
        glow: handles.find(Slot::BLOOM)?,
        levels: BloomChain::new(&own, size_texels).levels,
        flare: handles.find(Slot::FLARE),
        dirt: handles.find(Slot::LENS_DIRT),
        settings: own,
    })
}
