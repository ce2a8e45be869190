//! Stages of what a lens does to the radiance.

use super::{Declared, Settings, StandardWorld};
use crate::bloom::{BloomChain, BloomMix, BloomSettings};
use crate::dof::{DofSettings, depth_of_field};
use crate::stages::{Handles, Slot};
use framegraph_wgpu::Frame;

pub(super) fn dof<W: StandardWorld + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: &Settings,
) -> Declared {
    match settings.dof.filter(DofSettings::is_seen) {
        Some(own) => depth_of_field(frame, handles, &own, settings.size_texels),
        None => Ok(()),
    }
}

/// A stage may have handed on what glows of its own.
pub(super) fn bloom<W: StandardWorld + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: &Settings,
) -> Declared {
    match settings.bloom.filter(BloomSettings::is_seen) {
        Some(own) if handles.find(Slot::BLOOM).is_none() => {
            let own = BloomSettings { fireflies: own.fireflies && settings.taa.is_none(), ..own };
            crate::bloom::bloom(frame, handles, &own, settings.size_texels)
        }
        _ => Ok(()),
    }
}

/// What glows as post-processing takes it.
pub(super) fn mix_of(handles: &Handles, settings: &Settings) -> Option<BloomMix> {
    let own = settings.bloom.filter(BloomSettings::is_seen)?;
    Some(BloomMix {
        glow: handles.find(Slot::BLOOM)?,
        levels: BloomChain::new(&own, settings.size_texels).levels,
        flare: handles.find(Slot::FLARE),
        dirt: handles.find(Slot::LENS_DIRT),
        settings: own,
    })
}
