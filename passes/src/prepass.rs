//! Depth prepass: the depth of the visible surfaces, so that the color pass shades each pixel once.

use crate::draw::{DepthDraw, draw_depth};
use crate::world::World;
use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Pass, PassBuilder, Texture, TextureDesc};
use framegraph_wgpu::Record;
use framegraph_wgpu::{Cx, Depth, RecordError};

/// Format of the depth attachment: 32-bit float, in which reversed Z spreads precision evenly over distance.
pub const DEPTH_FORMAT: Format = Format::Depth32Float;

/// Draws opaque and masked surfaces into a new depth texture; depth is reversed and cleared to the far plane.
#[derive(Clone, Copy, Debug)]
pub struct Prepass {
    /// Samples per texel.
    pub samples: u8,
}

impl Pass for Prepass {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        let depth = pass.texture("depth", TextureDesc::new(Extent::FRAME, DEPTH_FORMAT).samples(self.samples));
        pass.depth(depth, Intent::Clear(ClearValue::FAR_REVERSED))
    }
}

impl Record<World> for Prepass {
    fn record(&self, _: &Texture, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let frame = cx.uniform(&world.view.frame);
        let draw = DepthDraw { programs: &world.programs.prepass, depth: Depth::NEARER, lists: &world.view.seen };
        draw_depth(&draw, world, cx, |name| (name == "frame").then(|| frame.clone()))
    }
}
