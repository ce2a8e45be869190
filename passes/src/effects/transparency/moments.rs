//! Moment-based transparency: one pass over the surfaces adds up where they absorb, a second one shades them.
//!
//! `shaders/wgsl/lib/moment_transparency.wgsl` has the arithmetic. Distances are warped to the range that blended surfaces in
//! view lie in, so that no depth of a scene is too large.

use super::settings::{MomentPrecision, MomentTransparency};
use super::surfaces::{ADDED, BlendedDraw, BlendedInputs, BlendedSurfaces, TESTED};
use crate::effects::color::surface::{HDR_FORMAT, SurfaceWorld};
use crate::gpu_scene::lighting::Lighting;
use crate::gpu_scene::upload::GpuScene;
use crate::gpu_scene::view::Views;
use crate::program::Programs;
use framegraph::{ClearValue, DeclareError, Format, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_wgpu::{Cx, Output, Record, RecordError};

/// Adds up absorbance and its moments.
#[derive(Clone, Copy, Debug)]
pub struct Absorbance {
    /// What is drawn.
    pub surfaces: BlendedSurfaces,
    /// Depth of what hides blended surfaces; the sums get its size and samples.
    pub depth: Texture,
    /// How sums are stored; depth of several samples asks for `Half`.
    pub precision: MomentPrecision,
}

/// Sums of absorbance.
#[derive(Clone, Copy, Debug)]
pub struct AbsorbanceSums {
    /// Of each sample.
    pub total_samples: Texture,
    /// The mean of a texel's samples; `total_samples` itself at one sample per texel.
    pub total: Texture,
    /// The mean of the moments of a texel's samples.
    pub moments: Texture,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct AbsorbanceIo {
    /// What it added up.
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

/// Shades surfaces, each by what those in front of it let through.
#[derive(Clone, Copy, Debug)]
pub struct MomentShade {
    /// What is drawn.
    pub surfaces: BlendedSurfaces,
    /// Depth of what hides blended surfaces.
    pub depth: Texture,
    /// What [`Absorbance`] added up.
    pub sums: AbsorbanceSums,
    /// How the estimate is made of it.
    pub moments: MomentTransparency,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct MomentShadeIo {
    inputs: BlendedInputs,
    sums: [View; 2],
    /// Colors and alphas, both times what surfaces in front let through.
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
