//! Moment-based transparency: one pass over the surfaces sums up absorbance, a second one shades them.
//!
//! `shaders/wgsl/lib/moment_transparency.wgsl` has the math. Distances are warped to the range of visible blended
//! surfaces, so scenes can have any depth.

use super::settings::{MomentPrecision, MomentTransparency};
use super::surfaces::{ADDED, BlendedDraw, BlendedInputs, BlendedSurfaces, TESTED};
use crate::effects::color::surface::{HDR_FORMAT, SurfaceWorld};
use crate::gpu_scene::lighting::Lighting;
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::Views;
use crate::program::Programs;
use framegraph::{ClearValue, DeclareError, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_wgpu::{Cx, Output, Record, RecordError};

/// Sums up absorbance and its moments.
#[derive(Clone, Copy, Debug)]
pub struct Absorbance {
    /// Surfaces to draw.
    pub surfaces: BlendedSurfaces,
    /// Depth of opaque surfaces; the sums have its size and samples.
    pub depth: Texture,
    /// Format of the sums; multisampled depth requires `Half`.
    pub precision: MomentPrecision,
}

/// Sums of absorbance.
#[derive(Clone, Copy, Debug)]
pub struct AbsorbanceSums {
    /// Sum of absorbances of each sample.
    pub total_samples: Texture,
    /// Mean over the samples of a texel; the same as `total_samples` at one sample per texel.
    pub total: Texture,
    /// Moments, averaged over the samples of a texel.
    pub moments: Texture,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct AbsorbanceIo {
    /// Sums of absorbance.
    pub sums: AbsorbanceSums,
}

impl Pass for Absorbance {
    type Io = AbsorbanceIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<AbsorbanceIo, DeclareError> {
        let depth = pass.desc(self.depth)?;
        pass.depth_read_only(self.depth)?;
        let [total_format, moment_format] = match self.precision {
            MomentPrecision::Half => [Format::R16Float, Format::Rgba16Float],
            MomentPrecision::Full => [Format::R32Float, Format::Rgba32Float],
        };
        let desc = |format| TextureDesc::new(depth.extent, format);
        let samples = |format| desc(format).samples(depth.samples);
        let total = pass.texture("absorbance", samples(total_format));
        let moments = pass.texture("absorbance_moments", samples(moment_format));
        let clear = Intent::Clear(ClearValue::TRANSPARENT);
        let total_samples = pass.color_at(1, total, clear)?;
        let moment_samples = pass.color_at(2, moments, clear)?;
        let mut mean = |name, samples, format| match depth.samples {
            1 => Ok(samples),
            _ => {
                let into = pass.texture(name, desc(format));
                pass.resolve(samples, into)
            }
        };
        let sums = AbsorbanceSums {
            total_samples,
            total: mean("mean_absorbance", total_samples, total_format)?,
            moments: mean("mean_moments", moment_samples, moment_format)?,
        };
        Ok(AbsorbanceIo { sums })
    }
}

impl<W> Record<W> for Absorbance
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Lighting> + AsRef<Views> + ?Sized,
{
    fn record(&self, _: &AbsorbanceIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let world = SurfaceWorld::of(world, self.surfaces.view)?;
        let own = BlendedDraw {
            fragment: "fs_absorbance",
            depth: TESTED,
            colors: &[Output::REPLACE, ADDED, ADDED],
            inputs: None,
            moments: None,
        };
        self.surfaces.draw(&world.view.view.draws.blend, &world, own, cx)
    }
}

/// Shades surfaces, each weighted by the transmittance in front of it.
#[derive(Clone, Copy, Debug)]
pub struct MomentShade {
    /// Surfaces to draw.
    pub surfaces: BlendedSurfaces,
    /// Depth of opaque surfaces.
    pub depth: Texture,
    /// Sums of [`Absorbance`].
    pub sums: AbsorbanceSums,
    /// Settings of the estimate.
    pub moments: MomentTransparency,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct MomentShadeIo {
    inputs: BlendedInputs,
    sums: [View; 2],
    /// Colors and alphas, weighted by the transmittance in front of them.
    pub accumulated: Texture,
}

impl Pass for MomentShade {
    type Io = MomentShadeIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<MomentShadeIo, DeclareError> {
        let depth = pass.desc(self.depth)?;
        pass.depth_read_only(self.depth)?;
        let inputs = self.surfaces.inputs(pass)?;
        let AbsorbanceSums { total, moments, .. } = self.sums;
        let sums = match depth.samples {
            1 => [pass.same_pixel(total)?, pass.same_pixel(moments)?],
            _ => [pass.sampled(total)?, pass.sampled(moments)?],
        };
        let desc = TextureDesc::new(depth.extent, HDR_FORMAT).samples(depth.samples);
        let accumulated = pass.texture("moment_color", desc);
        let accumulated = pass.color_at(3, accumulated, Intent::Clear(ClearValue::TRANSPARENT))?;
        Ok(MomentShadeIo { inputs, sums, accumulated })
    }
}

impl<W> Record<W> for MomentShade
where
    W: AsRef<Programs> + AsRef<GpuScene> + AsRef<Lighting> + AsRef<Views> + ?Sized,
{
    fn record(&self, io: &MomentShadeIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let world = SurfaceWorld::of(world, self.surfaces.view)?;
        let own = BlendedDraw {
            fragment: "fs_moments",
            depth: TESTED,
            colors: &[Output::REPLACE, Output::REPLACE, Output::REPLACE, ADDED],
            inputs: Some(io.inputs),
            moments: Some((io.sums, [self.moments.precision.bias(), self.moments.overestimation])),
        };
        self.surfaces.draw(&world.view.view.draws.blend, &world, own, cx)
    }
}
