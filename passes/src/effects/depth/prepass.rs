//! Depth prepass: draws the depth of visible surfaces, so that the color pass shades each pixel once.

use crate::gpu_scene::draw::{DepthDraw, SurfaceDraw};
use crate::gpu_scene::indirect::DrawList;
use crate::gpu_scene::upload::{GpuScene, MATERIAL_BINDINGS};
use crate::gpu_scene::view::{GpuView, ViewId, Views};
use crate::program::{Interface, Programs};
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Depth, Record, RecordError};

/// Format of the depth attachment: 32-bit float, in which reversed depth spreads precision evenly over distance.
pub const DEPTH_FORMAT: Format = Format::Depth32Float;
/// Format of the depth attachment if any material uses stencil.
pub const DEPTH_STENCIL_FORMAT: Format = Format::Depth32FloatStencil8;

/// Shader of the prepass.
pub(crate) static PREPASS_SHADER: Module<'static> = library::pass("pass/prepass.wgsl").unwrap();

static INTERFACE: Interface = Interface {
    groups: &[&["frame", "eyes"], &MATERIAL_BINDINGS, &["objects", "origins"]],
    constants: &[SurfaceDraw::TRAITS],
};

/// Draws opaque and masked surfaces into a new reversed-depth texture, cleared to the far plane.
#[derive(Clone, Copy, Debug)]
pub struct Prepass {
    /// View to draw.
    pub view: ViewId,
    /// Size of the view's pictures. Passes that shade over this depth use its size.
    pub extent: Extent,
    /// Samples per texel.
    pub samples: u8,
    /// Adds a stencil aspect, for materials that use stencil.
    pub stencil: bool,
    /// Number of layers: 2 draws both eyes of a stereo view ([`CameraView::stereo`](crate::CameraView::stereo)).
    pub layers: u16,
}

impl Default for Prepass {
    /// Returns the pass for the main view at the frame's size, with one sample per texel.
    fn default() -> Self {
        Self { view: ViewId::MAIN, extent: Extent::FRAME, samples: 1, stencil: false, layers: 1 }
    }
}

impl Pass for Prepass {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        new_depth(pass, self.extent, self.samples, (self.stencil, self.layers))
    }
}

/// Declares a new depth attachment, cleared to the far plane and, with `stencil`, to stencil 0.
pub(crate) fn new_depth(
    pass: &mut PassBuilder<'_>,
    extent: Extent,
    samples: u8,
    (stencil, layers): (bool, u16),
) -> Result<Texture, DeclareError> {
    let format = if stencil { DEPTH_STENCIL_FORMAT } else { DEPTH_FORMAT };
    let depth = pass.texture("depth", TextureDesc::new(extent, format).samples(samples).layers(layers));
    pass.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED))
}

impl<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized> Record<W> for Prepass {
    fn record(&self, _: &Texture, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        draw_depth(self.view, self.stencil, world, cx)
    }
}

/// Draws the depth of a view's opaque and masked surfaces, optionally with the stencil states of materials.
pub(crate) fn draw_depth<W>(view: ViewId, stencil: bool, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError>
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized,
{
    let views: &Views = world.as_ref();
    let view = views.get(view)?;
    draw_batches(&view.view.draws.depth, view, stencil, world.as_ref(), world.as_ref(), cx)
}

/// Draws the depth of a list of a view's instances, regardless of their alpha.
pub(crate) fn draw_depth_of(
    list: &DrawList,
    view: &GpuView,
    stencil: bool,
    scene: &GpuScene,
    programs: &Programs,
    cx: &mut Cx<'_>,
) -> Result<(), RecordError> {
    draw_batches(&[list.clone(), DrawList::default()], view, stencil, scene, programs, cx)
}

fn draw_batches(
    batches: &[DrawList; 2],
    view: &GpuView,
    stencil: bool,
    scene: &GpuScene,
    programs: &Programs,
    cx: &mut Cx<'_>,
) -> Result<(), RecordError> {
    let frame = &[Some(cx.uniform(&view.view.frame)), view.view.eyes.map(|eyes| cx.uniform(&eyes))];
    let draw = DepthDraw { shader: &PREPASS_SHADER, interface: &INTERFACE, frame, depth: Depth::NEARER, batches };
    draw.draw(view.instances(scene).with_stencil(stencil), programs, cx)
}
