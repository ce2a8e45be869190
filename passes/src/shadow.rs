//! The sun's shadow map: depth of the scene as the sun sees it, one cascade fitted to the scene.

use crate::draw::{DepthDraw, InstanceSource};
use crate::program::{Interface, Programs};
use crate::upload::{GpuScene, MATERIAL_BINDINGS};
use crate::view::{ViewId, Views};
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Depth, Record, RecordError};
use wgpu::DepthBiasState;

/// Format of the map: sixteen bits would do for a fitted view, but not every adapter compares them alike.
pub const SHADOW_FORMAT: Format = Format::Depth32Float;

/// Polygon offset away from the sun (depth is reversed, so it is negative): slope-scaled 2, as Filament has it. The
/// receiver adds an offset along its normal.
const BIAS: DepthBiasState = DepthBiasState { constant: 0, slope_scale: -2.0, clamp: 0.0 };

static SHADER: Module<'static> = library::pass("pass/shadow.wgsl").unwrap();

static INTERFACE: Interface =
    Interface { groups: &[&["shadow_view"], &MATERIAL_BINDINGS, &["objects"]], constants: &[] };

/// Draws every caster into a new square map; depth is reversed and cleared to the far end.
///
/// One map serves all views of the scene: the fit depends on the scene and the sun alone.
#[derive(Clone, Copy, Debug)]
pub struct Shadow {
    /// Width and height of the map in texels, as the views' [`ViewSettings`](crate::ViewSettings) have it.
    pub map_texels: u32,
    /// The view whose placement of instances the casters are drawn with. Any view of the scene gives the same map up to
    /// the rounding of positions relative to its eye.
    pub view: ViewId,
}

impl Pass for Shadow {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        let extent = Extent::absolute(self.map_texels, self.map_texels);
        let map = pass.texture("shadow_map", TextureDesc::new(extent, SHADOW_FORMAT));
        pass.depth(map, Intent::Clear(ClearValue::FAR_REVERSED))
    }
}

impl<W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Views> + ?Sized> Record<W> for Shadow {
    fn record(&self, _: &Texture, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let views: &Views = world.as_ref();
        let view = views.get(self.view)?;
        let draw = DepthDraw {
            shader: &SHADER,
            interface: &INTERFACE,
            frame: &[Some(cx.uniform(&view.view.shadow))],
            depth: Depth { bias: BIAS, ..Depth::NEARER },
            lists: &view.view.casters,
        };
        draw.draw(InstanceSource { scene: world.as_ref(), objects: &view.objects }, world.as_ref(), cx)
    }
}
