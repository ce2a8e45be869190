//! Stages before surfaces are shaded: depth, ambient occlusion, reflections.

use crate::effects::depth::prepass::Prepass;
use crate::effects::depth::structure::{Resolution, structure};
use crate::effects::occlusion;
use crate::effects::occlusion::OcclusionSettings;
use crate::effects::reflection::{ReflectionSettings, reflections};
use crate::effects::taa::velocity::Velocity;
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::Views;
use crate::program::Programs;
use crate::settings::precision::Precision;
use crate::stages::{Handles, Slot, StageError};
use framegraph::Format;
use framegraph_wgpu::Frame;

/// Declares the depth and motion vectors of visible surfaces, if requested.
pub(super) fn prepass<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    samples: u8,
    [drawn, moving, stencil]: [bool; 3],
) -> Result<(), StageError> {
    if !drawn {
        return Ok(());
    }
    let depth = frame.add(
        "prepass",
        Prepass { view: handles.view(), extent: handles.extent(), samples, stencil, layers: handles.layers() },
    )?;
    handles.set(Slot::DEPTH, depth);
    if moving {
        handles.set(Slot::VELOCITY, frame.add("velocity", Velocity { view: handles.view(), depth })?);
    }
    Ok(())
}

/// Declares ambient occlusion, unless a stage has already provided it.
pub(super) fn occlusion<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: Option<OcclusionSettings>,
    (structure_levels, precision): (u8, Precision),
) -> Result<(), StageError> {
    match settings.filter(OcclusionSettings::occludes) {
        Some(own) if handles.find(Slot::OCCLUSION).is_none() => {
            occlusion::occlusion(frame, handles, &own, structure_levels, precision)
        }
        _ => Ok(()),
    }
}

/// Declares the structure at full resolution, if contact shadows or reflections read it.
pub(super) fn full_structure<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    (wanted, levels): (bool, u8),
) -> Result<(), StageError> {
    if wanted {
        structure(frame, handles, Resolution::Full, levels)?;
    }
    Ok(())
}

/// Declares reflections, unless a stage has already provided them.
pub(super) fn reflection<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    settings: Option<ReflectionSettings>,
    structure_levels: u8,
    (levels, format): (u8, Format),
) -> Result<(), StageError> {
    match settings {
        Some(own) if handles.find(Slot::REFLECTIONS).is_none() => {
            reflections(frame, handles, &own, (Resolution::Full, structure_levels), levels, format)
        }
        _ => Ok(()),
    }
}
