//! Depth peeling: draws layers of blended surfaces one by one, from the nearest (Everitt, "Interactive
//! order-independent transparency", 2001).
//!
//! Each layer is two passes in one step. The first finds the nearest depth behind the previous layer that opaque
//! surfaces do not hide. The second shades surfaces at that depth. Surfaces at equal depth share a layer and are all
//! shaded, in the order of sorting. Texels without coverage are not a layer.

use super::surfaces::{BEHIND, BlendedDraw, BlendedInputs, BlendedSurfaces};
use crate::effects::color::surface::{HDR_FORMAT, SurfaceWorld};
use crate::effects::depth::prepass::{DEPTH_FORMAT, PREPASS_SHADER};
use crate::effects::depth::resolve::can_read_samples;
use crate::gpu_scene::draw::{SurfaceDraw, SurfaceVariant};
use crate::gpu_scene::indirect::DrawList;
use crate::gpu_scene::lighting::Lighting;
use crate::gpu_scene::upload::{GpuScene, MATERIAL_BINDINGS};
use crate::gpu_scene::view::{CameraView, ViewId, Views};
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{ClearValue, DeclareError, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_scene::Batch;
use framegraph_wgpu::{Cx, Depth, Record, RecordError};

/// The shader reads depth as one of two variables, depending on its sample count.
static INTERFACE: Interface = Interface {
    groups: &[
        &["frame", "opaque_depth", "opaque_depth_samples", "nearer_layer", "nearer_layer_samples"],
        &MATERIAL_BINDINGS,
        &["objects", "origins"],
    ],
    constants: &[SurfaceDraw::TRAITS, SurfaceDraw::OBJECT_LIGHT, "FIRST_LAYER"],
};

/// Finds the depth of a layer of blended surfaces.
#[derive(Clone, Copy, Debug)]
pub struct PeelDepth {
    /// View to draw.
    pub view: ViewId,
    /// Depth of opaque surfaces; the layer has its size and samples.
    pub opaque: Texture,
    /// Depth of the previous layer; `None` for the first.
    pub nearer: Option<Texture>,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct PeelDepthIo {
    read: [View; 2],
    samples: u8,
    /// Reversed depth of the layer; 0 where it is empty.
    pub depth: Texture,
}

impl Pass for PeelDepth {
    type Io = PeelDepthIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<PeelDepthIo, DeclareError> {
        let desc = pass.desc(self.opaque)?;
        let opaque = pass.same_pixel(self.opaque)?;
        let nearer = self.nearer.map_or(Ok(opaque), |nearer| pass.same_pixel(nearer))?;
        let depth = TextureDesc::new(desc.extent, DEPTH_FORMAT).samples(desc.samples);
        let depth = pass.texture("layer_depth", depth);
        let depth = pass.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED))?;
        Ok(PeelDepthIo { read: [opaque, nearer], samples: desc.samples, depth })
    }
}

impl<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized> Record<W> for PeelDepth {
    fn record(&self, io: &PeelDepthIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        can_read_samples(io.samples, cx.gpu())?;
        let (programs, views): (&Programs, &Views) = (world.as_ref(), world.as_ref());
        let view = views.get(self.view)?;
        let [opaque, nearer] = io.read.map(|view| cx.view(view));
        let (opaque, nearer) = (opaque?, nearer?);
        let frame = cx.uniform(&view.view.frame);
        let read = [opaque.clone(), opaque, nearer.clone(), nearer];
        let provided: Vec<_> = [frame].into_iter().chain(read.map(Into::into)).map(Some).collect();
        let fragment = Some(if io.samples == 1 { "fs_peel" } else { "fs_peel_samples" });
        let program = |variant: SurfaceVariant| {
            let features = &variant.vertex_features();
            let desc = ProgramDesc { vertex: "vs_mask", fragment, ..ProgramDesc::new(&PREPASS_SHADER, &INTERFACE) };
            programs.get(&ProgramDesc { features, ..desc })
        };
        let layer = SurfaceDraw {
            program: &program,
            frame: &provided,
            constants: &[f64::from(self.nearer.is_none())],
            depth: Depth::NEARER,
            colors: &[],
        };
        layer.draw(&view.view.draws.blend, view.instances(world.as_ref()), cx)
    }
}

/// Shades a layer of blended surfaces behind the previous layers.
#[derive(Clone, Copy, Debug)]
pub struct PeelLayer {
    /// Surfaces to draw.
    pub surfaces: BlendedSurfaces,
    /// Depth of the layer.
    pub depth: Texture,
    /// The previous layers; `None` for the first.
    pub nearer: Option<Texture>,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct PeelLayerIo {
    inputs: BlendedInputs,
    /// Color of all layers so far, and their transmittance in alpha.
    pub layers: Texture,
}

impl Pass for PeelLayer {
    type Io = PeelLayerIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<PeelLayerIo, DeclareError> {
        let desc = pass.desc(self.depth)?;
        pass.depth_read_only(self.depth)?;
        let inputs = self.surfaces.inputs(pass)?;
        let layers = match self.nearer {
            Some(nearer) => pass.color(nearer, Intent::Modify)?,
            None => {
                let layers = TextureDesc::new(desc.extent, HDR_FORMAT).samples(desc.samples);
                let layers = pass.texture("peeled_layers", layers);
                pass.color(layers, Intent::Clear(ClearValue::BLACK))?
            }
        };
        Ok(PeelLayerIo { inputs, layers })
    }
}

impl<W> Record<W> for PeelLayer
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Lighting> + AsRef<Views> + ?Sized,
{
    fn record(&self, io: &PeelLayerIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let world = SurfaceWorld::of(world, self.surfaces.view)?;
        let own = BlendedDraw {
            fragment: "fs_main",
            depth: Depth::EQUAL,
            colors: &[BEHIND],
            inputs: Some(io.inputs),
            moments: None,
        };
        self.surfaces.draw(&nearest_first(&world.view.view), &world, own, cx)
    }
}

/// Returns the draws of blended surfaces in reverse order, one instance each. At equal depth, sorting shows the last
/// surface in front, and a layer shows the first.
fn nearest_first(view: &CameraView) -> DrawList {
    let draws = &view.draws;
    let alone = |batch: &Batch| {
        let own = *batch;
        let instance = |first: u32| draws.numbers[first as usize];
        batch.range().rev().map(move |first| Batch { instance: instance(first), first, count: 1, ..own })
    };
    draws.blend.iter().rev().flat_map(alone).collect::<Vec<_>>().into()
}
