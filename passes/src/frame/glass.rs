//! Stages of refractive surfaces: the picture behind them, and their layers.

use super::shadows::maps_of;
use crate::effects::fog::FogSettings;
use crate::effects::transmission::{Layer, MAX_GLASS_LAYERS, SceneCopy, SceneLevel, Transparent};
use crate::effects::transparency::Transparency;
use crate::gpu_scene::lighting::Lighting;
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::Views;
use crate::light::shading::Shading;
use crate::program::Programs;
use crate::stages::{Handles, Slot, StageError};
use framegraph::{AccessKind, Texture};
use framegraph_wgpu::Frame;

/// Settings of refractive surfaces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Glass {
    /// Number of levels of the picture behind them; 0 if no surface is refractive.
    pub levels: u8,
    /// Number of refractive layers visible through each other.
    pub layers: u8,
    /// Samples per texel of the color pass.
    pub samples: u8,
    /// Settings of surface shading.
    pub shading: Shading,
    /// Fog in front of the surfaces.
    pub fog: Option<FogSettings>,
    /// Technique for blended surfaces.
    pub transparency: Transparency,
}

/// Declares the picture behind refractive surfaces, with one pass for each level.
pub(super) fn scene<W: AsRef<Programs> + AsRef<Views> + ?Sized>(
    frame: &mut Frame<W>,
    handles: &mut Handles,
    levels: u8,
) -> Result<(), StageError> {
    if levels == 0 {
        return Ok(());
    }
    let told = format_args!("surfaces of the scene transmit: what is behind them is copied, in {levels} levels");
    frame.graph_mut().note("scene", told);
    let copy =
        SceneCopy { view: handles.view(), hdr: handles.get(Slot::HDR)?, depth: handles.get(Slot::DEPTH)?, levels };
    let scene = frame.scope("scene", |frame| {
        let mut scene = frame.add("copy", copy)?.scene;
        for level in 1..levels {
            scene = frame.add("level", SceneLevel { scene, level })?.scene;
        }
        Ok::<Texture, StageError>(scene)
    })?;
    handles.set(Slot::SCENE_LEVELS, scene);
    Ok(())
}

/// Declares the refractive layers from back to front. The previous stage provides the picture behind the first layer.
pub(super) fn transparent<W>(frame: &mut Frame<W>, handles: &mut Handles, glass: &Glass) -> Result<(), StageError>
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Lighting> + AsRef<Views> + ?Sized,
{
    if glass.levels == 0 {
        return Ok(());
    }
    let multisampled = glass.samples > 1;
    for layer in Layer::all(glass.layers.clamp(1, MAX_GLASS_LAYERS)) {
        if !layer.last {
            scene(frame, handles, glass.levels)?;
        }
        let hdr = handles.get(Slot::HDR)?;
        let samples = if multisampled { handles.get(Slot::HDR_SAMPLES)? } else { hdr };
        let averaged = frame.graph().writer_of(hdr).is_some_and(|access| access.kind == AccessKind::Resolve);
        if multisampled && !averaged {
            return Err(handles.lost(Slot::HDR, Slot::HDR_SAMPLES));
        }
        let pass = Transparent {
            view: handles.view(),
            depth: handles.get(Slot::DEPTH)?,
            scene: handles.get(Slot::SCENE_LEVELS)?,
            hdr,
            samples,
            shadow: maps_of(handles),
            layer,
            transparency: glass.transparency,
            shading: glass.shading,
            fog: glass.fog,
        };
        let io = frame.add("transparent", pass)?;
        handles.set(Slot::HDR, io.hdr);
        if multisampled {
            handles.set(Slot::HDR_SAMPLES, io.samples);
        }
        handles.set(Slot::DEPTH, io.depth);
    }
    Ok(())
}
