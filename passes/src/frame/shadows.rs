//! The stage that draws shadow maps.

use crate::effects::shadow::{maps_slot, shadow_maps};
use crate::gpu_scene::shadow_views::{ShadowMaps, ShadowSettings};
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::Views;
use crate::program::Programs;
use crate::stages::{Handles, StageError};
use framegraph_wgpu::Frame;

/// Declares shadow maps, unless a stage has already provided them.
pub(super) fn shadow<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: Option<ShadowSettings>,
) -> Result<(), StageError> {
    handles.check_shadow_maps()?;
    let Some(shadows) = settings.filter(|_| maps_of(handles).is_none()) else { return Ok(()) };
    if let Some(maps) = shadow_maps(frame, handles.view(), &shadows)? {
        handles.set_shadow_maps(maps_slot(&shadows), maps);
    }
    Ok(())
}

/// Returns the shadow maps: depth, or moments.
pub(super) fn maps_of(handles: &Handles) -> Option<ShadowMaps> {
    handles.shadow_maps()
}
