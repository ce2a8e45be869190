//! The sun's shadow map: depth of the scene as the sun sees it, one cascade fitted to the scene.

mod fit;

pub use fit::{SunView, fit};

use crate::draw::{DepthDraw, draw_depth};
use crate::world::World;
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc};
use framegraph_wgpu::Record;
use framegraph_wgpu::{Cx, Depth, RecordError};
use wgpu::DepthBiasState;

/// Format of the map: sixteen bits would do for a fitted view, but not every adapter compares them alike.
pub const SHADOW_FORMAT: Format = Format::Depth32Float;

/// Polygon offset away from the sun (depth is reversed, so it is negative): slope-scaled 2, as Filament has it. The
/// receiver adds an offset along its normal.
const BIAS: DepthBiasState = DepthBiasState { constant: 0, slope_scale: -2.0, clamp: 0.0 };

/// Draws every caster into a new square map; depth is reversed and cleared to the far end.
#[derive(Clone, Copy, Debug)]
pub struct Shadow {
    /// Width and height of the map.
    pub map_texels: u32,
}

impl Pass for Shadow {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        let extent = Extent::absolute(self.map_texels, self.map_texels);
        let map = pass.texture("shadow_map", TextureDesc::new(extent, SHADOW_FORMAT));
        pass.depth(map, Intent::Clear(ClearValue::FAR_REVERSED))
    }
}

impl Record<World> for Shadow {
    fn record(&self, _: &Texture, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let view = cx.uniform(&world.view.shadow);
        let depth = Depth { bias: BIAS, ..Depth::NEARER };
        let draw = DepthDraw { programs: &world.programs.shadow, depth, lists: &world.view.casters };
        draw_depth(&draw, world, cx, |name| (name == "shadow_view").then(|| view.clone()))
    }
}
