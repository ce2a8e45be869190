//! Weighted blended transparency: one pass over the surfaces, in any order.
//!
//! Exact for one layer, and for layers of the same color. Otherwise nearer colors have more weight; see
//! `shaders/wgsl/lib/weighted_blending.wgsl`.

use super::surfaces::{ADDED, BlendedDraw, BlendedInputs, BlendedSurfaces, MULTIPLIED, TESTED};
use crate::effects::color::surface::{HDR_FORMAT, SurfaceWorld};
use crate::gpu_scene::lighting::Lighting;
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::Views;
use crate::program::Programs;
use framegraph::{ClearValue, DeclareError, Format, Intent, Pass, PassBuilder, Texture, TextureDesc};
use framegraph_wgpu::{Cx, Output, Record, RecordError};

/// Sums up weighted colors, and multiplies transmittances.
#[derive(Clone, Copy, Debug)]
pub struct Weighted {
    /// Surfaces to draw.
    pub surfaces: BlendedSurfaces,
    /// Depth of opaque surfaces; the sums have its size and samples.
    pub depth: Texture,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct WeightedIo {
    inputs: BlendedInputs,
    /// Colors and alphas, multiplied by their weights.
    pub accumulated: Texture,
    /// Product of the transmittances of all surfaces.
    pub transmittance: Texture,
}

impl Pass for Weighted {
    type Io = WeightedIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<WeightedIo, DeclareError> {
        let depth = pass.desc(self.depth)?;
        pass.depth_read_only(self.depth)?;
        let inputs = self.surfaces.inputs(pass)?;
        let desc = |format| TextureDesc::new(depth.extent, format).samples(depth.samples);
        let accumulated = pass.texture("weighted_color", desc(HDR_FORMAT));
        let transmittance = pass.texture("transmittance", desc(Format::R16Float));
        // Slot 0 holds the radiance of the color pass, so both passes share a step.
        Ok(WeightedIo {
            inputs,
            accumulated: pass.color_at(1, accumulated, Intent::Clear(ClearValue::TRANSPARENT))?,
            transmittance: pass.color_at(2, transmittance, Intent::Clear(ClearValue::Color([1.0; 4])))?,
        })
    }
}

impl<W> Record<W> for Weighted
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Lighting> + AsRef<Views> + ?Sized,
{
    fn record(&self, io: &WeightedIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let world = SurfaceWorld::of(world, self.surfaces.view)?;
        let own = BlendedDraw {
            fragment: "fs_weighted",
            depth: TESTED,
            colors: &[Output::REPLACE, ADDED, MULTIPLIED],
            inputs: Some(io.inputs),
            moments: None,
        };
        self.surfaces.draw(&world.view.view.draws.blend, &world, own, cx)
    }
}
