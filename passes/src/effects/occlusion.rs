//! Ambient occlusion from the structure of the scene.
//!
//! ```text
//! structure ─> occlusion ─> occlusion_blur (across) ─> occlusion_blur (down) ─> color
//! ```
//!
//! Estimates the visible fraction of the environment from the depth around a pixel, within
//! [`OcclusionSettings::radius_m`]. Two methods are available: scalable ambient obscurance as in Filament
//! ([`Method::Sao`]), and horizons in slices ([`Method::Gtao`]). The color pass takes the lesser of it and the
//! material's own occlusion, and occludes reflections with it. `docs/design/occlusion.md` has cost and error of each.

mod blur;
mod fields;
mod pass;
mod settings;

pub use blur::{Axis, OcclusionBlur, OcclusionBlurIo};
pub use pass::{AmbientOcclusion, AmbientOcclusionIo};
pub use settings::{Blur, ConeTrace, Gtao, Method, Occluders, OcclusionSettings, SaoQuality};

use crate::effects::depth::structure::structure;
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::Views;
use crate::program::Programs;
use crate::settings::precision::Precision;
use crate::stages::{Handles, Slot, StageError};
use framegraph_wgpu::Frame;

/// Declares ambient occlusion of a view, with the structure of this number of levels; sets [`Slot::OCCLUSION`].
///
/// # Errors
/// Returns the error of a refused pass.
pub fn occlusion<W>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: &OcclusionSettings,
    structure_levels: u8,
    precision: Precision,
) -> Result<(), StageError>
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized,
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
            let bent_normals = settings.has_bent_normals();
            let pass = OcclusionBlur { view, structure, occlusion, blur, axis, bent_normals };
            occlusion = frame.add("occlusion_blur", pass)?.blurred;
        }
    }
    handles.set(Slot::OCCLUSION, occlusion);
    Ok(())
}
