//! Depth prepass: the depth of the visible surfaces, so that the color pass shades each pixel once.

use crate::gpu_scene::draw::{DepthDraw, SurfaceDraw};
use crate::gpu_scene::indirect::DrawList;
use crate::gpu_scene::upload::{GpuScene, MATERIAL_BINDINGS};
use crate::gpu_scene::view::{GpuView, ViewId, Views};
use crate::program::{Interface, Programs};
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Depth, Record, RecordError};

/// Format of the depth attachment: 32-bit float, in which reversed Z spreads precision evenly over distance.
pub const DEPTH_FORMAT: Format = Format::Depth32Float;
/// Format of the depth attachment where a material uses stencil.
pub const DEPTH_STENCIL_FORMAT: Format = Format::Depth32FloatStencil8;

/// Draws depth.
pub(crate) static PREPASS_SHADER: Module<'static> = library::pass("pass/prepass.wgsl").unwrap();

static INTERFACE: Interface =
    Interface { groups: &[&["frame"], &MATERIAL_BINDINGS, &["objects", "origins"]], constants: &[SurfaceDraw::TRAITS] };

/// Draws opaque and masked surfaces into a new depth texture; depth is reversed and cleared to the far plane.
#[derive(Clone, Copy, Debug)]
pub struct Prepass {
    /// The view that is drawn.
    pub view: ViewId,
    /// Size of the view's pictures; passes that shade over this depth take theirs from it.
    pub extent: Extent,
    /// Samples per texel.
    pub samples: u8,
    /// Materials test and write stencil, which the depth then has.
    pub stencil: bool,
}

impl Default for Prepass {
    /// The main view in the frame's size, one sample per texel.
    fn default() -> Self {
        Self { view: ViewId::MAIN, extent: Extent::FRAME, samples: 1, stencil: false }
    }
}

impl Pass for Prepass {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        new_depth(pass, self.extent, self.samples, self.stencil)
    }
}

/// A new depth texture that the pass draws into, cleared to the far plane; with a `stencil` of 0, or without.
pub(crate) fn new_depth(
    pass: &mut PassBuilder<'_>,
    extent: Extent,
    samples: u8,
    stencil: bool,
) -> Result<Texture, DeclareError> {
    let format = if stencil { DEPTH_STENCIL_FORMAT } else { DEPTH_FORMAT };
    let depth = pass.texture("depth", TextureDesc::new(extent, format).samples(samples));
    pass.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED))
}

impl<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized> Record<W> for Prepass {
    fn record(&self, _: &Texture, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        draw_depth(self.view, self.stencil, world, cx)
    }
}

/// Draws the depth of what a view sees, opaque and masked, with the stencil states of materials or without.
pub(crate) fn draw_depth<W>(view: ViewId, stencil: bool, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError>
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized,
{
    let views: &Views = world.as_ref();
    let view = views.get(view)?;
    draw_batches(&view.view.draws.depth, view, stencil, world.as_ref(), world.as_ref(), cx)
}

/// Draws the depth of a list of a view's instances, whatever their alpha is.
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
    let frame = &[Some(cx.uniform(&view.view.frame))];
    let draw = DepthDraw { shader: &PREPASS_SHADER, interface: &INTERFACE, frame, depth: Depth::NEARER, batches };
    draw.draw(view.instances(scene).with_stencil(stencil), programs, cx)
}
