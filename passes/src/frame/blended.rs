//! Order-independent transparency: separate passes after refractive surfaces.

use super::shadows::maps_of;
use crate::effects::fog::FogSettings;
use crate::effects::transparency::{
    Absorbance, BlendedComposite, BlendedSums, BlendedSurfaces, MAX_PEEL_LAYERS, MomentPrecision, MomentShade,
    MomentTransparency, PeelDepth, PeelLayer, Transparency, Weighted,
};
use crate::gpu_scene::lighting::Lighting;
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::Views;
use crate::light::shading::Shading;
use crate::program::Programs;
use crate::stages::{Handles, Slot, StageError};
use framegraph::{Target, Texture};
use framegraph_wgpu::Frame;

/// Settings of blended surfaces.
#[derive(Clone, Copy, Debug)]
pub(super) struct Blended {
    /// Technique; sorted ones are drawn by other passes.
    pub transparency: Transparency,
    /// Samples per texel of the color pass.
    pub samples: u8,
    /// Settings of surface shading.
    pub shading: Shading,
    /// Fog in front of the surfaces.
    pub fog: Option<FogSettings>,
    /// True if the surfaces are drawn after depth of field. The next frame does not read that picture.
    pub after_blur: bool,
}

/// Declares the passes of an order-independent technique.
pub(super) fn blended<W>(frame: &mut Frame<W>, handles: &mut Handles, own: &Blended) -> Result<(), StageError>
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Lighting> + AsRef<Views> + ?Sized,
{
    let Blended { transparency, samples, shading, fog, after_blur } = *own;
    if !transparency.is_unordered() {
        return Ok(());
    }
    let (shadow, scene) = (maps_of(handles), handles.find(Slot::SCENE_LEVELS));
    let surfaces = BlendedSurfaces { view: handles.view(), shadow, scene, shading, fog };
    let depth = handles.get(Slot::DEPTH)?;
    let behind = handles.get(if samples > 1 { Slot::HDR_SAMPLES } else { Slot::HDR })?;
    let into = handles.find(Slot::HDR_HISTORY).filter(|_| !after_blur).map_or(Target::New, Target::from);
    frame.graph_mut().note("blended", format_args!("surfaces blend in any order: {}", transparency.name()));
    let io = frame.scope("blended", |frame| {
        let sums = match transparency {
            Transparency::Moments(own) => moments(frame, surfaces, depth, (own, samples))?,
            Transparency::Peeled { layers } => peeled(frame, surfaces, depth, layers)?,
            _ => {
                let io = frame.add("weighted", Weighted { surfaces, depth })?;
                BlendedSums::Weighted { accumulated: io.accumulated, transmittance: io.transmittance }
            }
        };
        frame.add("compose", BlendedComposite { behind, sums, into })
    })?;
    handles.set(Slot::HDR, io.hdr);
    if samples > 1 {
        handles.set(Slot::HDR_SAMPLES, io.samples);
    }
    Ok(())
}

type Summed = Result<BlendedSums, framegraph::DeclareError>;

fn moments<W>(
    frame: &mut Frame<W>,
    surfaces: BlendedSurfaces,
    depth: Texture,
    (moments, samples): (MomentTransparency, u8),
) -> Summed
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Lighting> + AsRef<Views> + ?Sized,
{
    let mut moments = moments;
    if samples > 1 && moments.precision == MomentPrecision::Full {
        let told = format_args!("moments of {samples} samples a texel are half floats: no device averages 32 bits");
        frame.graph_mut().note("moments", told);
        moments.precision = MomentPrecision::Half;
    }
    let sums = frame.add("absorbance", Absorbance { surfaces, depth, precision: moments.precision })?.sums;
    let accumulated = frame.add("shade", MomentShade { surfaces, depth, sums, moments })?.accumulated;
    Ok(BlendedSums::Moments { accumulated, absorbance: sums.total_samples })
}

fn peeled<W>(frame: &mut Frame<W>, surfaces: BlendedSurfaces, opaque: Texture, count: u8) -> Summed
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Lighting> + AsRef<Views> + ?Sized,
{
    let peel = PeelDepth { view: surfaces.view, opaque, nearer: None };
    let depth = frame.add("depth", peel)?.depth;
    let first = PeelLayer { surfaces, depth, nearer: None };
    let (mut depth, mut layers) = (depth, frame.add("layer", first)?.layers);
    for _ in 1..count.clamp(1, MAX_PEEL_LAYERS) {
        depth = frame.add("depth", PeelDepth { nearer: Some(depth), ..peel })?.depth;
        layers = frame.add("layer", PeelLayer { depth, nearer: Some(layers), ..first })?.layers;
    }
    Ok(BlendedSums::Peeled { layers })
}
