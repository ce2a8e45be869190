//! Ambient occlusion from the structure of the scene.
//!
//! ```text
//! structure ─> occlusion ─> occlusion_blur (across) ─> occlusion_blur (down) ─> color
//! ```
//!
//! What of the light from all around reaches a place is estimated from the depth that the picture shows about it, within
//! [`OcclusionSettings::radius_m`]. Two ways are built: scalable ambient obscurance as Filament has it ([`Method::Sao`]), and
//! horizons in slices ([`Method::Gtao`]). The color pass takes the lesser of it and the material's own occlusion, and occludes
//! reflections by it too. `docs/occlusion.md` has what each costs and how far off it is.

mod blur;
mod keys;
mod pass;
mod settings;

pub use blur::{Axis, OcclusionBlur, OcclusionBlurIo};
pub use pass::{AmbientOcclusion, AmbientOcclusionIo};
pub use settings::{Blur, ConeTrace, Gtao, Method, Occluders, OcclusionSettings, SaoQuality};

use crate::precision::Precision;
use crate::program::Programs;
use crate::stages::{Handles, Slot, StageError};
use crate::structure::structure;
use crate::upload::GpuScene;
use crate::view::Views;
use framegraph_wgpu::Frame;

/// Declares ambient occlusion of a view, and the structure that it needs with so many levels; hands on [`Slot::OCCLUSION`].
///
/// # Errors
/// What a pass refuses.
pub fn occlusion<W>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: &OcclusionSettings,
    structure_levels: u8,
    precision: Precision,
) -> Result<(), StageError>
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized + 'static,
{
    let method = if matches!(settings.method, Method::Sao { .. }) { "SAO" } else { "GTAO" };
    let told = format_args!("the settings ask for it: {method} within {} m", settings.radius_m);
    frame.graph_mut().note("occlusion", told);
    let view = handles.view();
    let structure = structure(frame, handles, settings.resolution, structure_levels)?;
    let pass = AmbientOcclusion { view, structure, settings: *settings, precision };
    let mut occlusion = frame.add("occlusion", pass)?.occlusion;
    if let Some(blur) = settings.blur {
        for axis in [Axis::Across, Axis::Down] {
            let pass = OcclusionBlur { view, structure, occlusion, blur, axis };
            occlusion = frame.add("occlusion_blur", pass)?.blurred;
        }
    }
    handles.set(Slot::OCCLUSION, occlusion);
    Ok(())
}
