//! FXAA: softens the edges of a finished picture.

use crate::world::World;
use framegraph::{DeclareError, Extent, Format, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View};
use framegraph_shaders::layout::FxaaUniforms;
use framegraph_wgpu::Record;
use framegraph_wgpu::{Constants, Cx, Raster, RecordError, SamplerDesc};

/// Filters a picture whose alpha is its luma.
#[derive(Clone, Copy, Debug)]
pub struct Fxaa {
    /// The picture, sRGB encoded in a linear format, luma in alpha.
    pub ldr: Texture,
    /// Where the result goes; new ones are eight bits a channel, sRGB.
    pub into: Target,
    /// Thresholds and sharpness.
    pub settings: FxaaUniforms,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct FxaaIo {
    ldr: View,
    /// The filtered picture.
    pub output: Texture,
}

impl Pass for Fxaa {
    type Io = FxaaIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<FxaaIo, DeclareError> {
        let ldr = pass.sampled(self.ldr)?;
        let into = pass.target(self.into, "antialiased", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
        Ok(FxaaIo { ldr, output: pass.color(into, Intent::Overwrite)? })
    }
}

impl Record<World> for Fxaa {
    fn record(&self, io: &FxaaIo, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let program = &world.programs.fxaa;
        let srgb = cx.targets().colors[0].is_some_and(Format::is_srgb);
        let constants = [("OUTPUT_ENCODED", f64::from(u8::from(!srgb)))];
        let pipeline =
            cx.raster_pipeline(&Raster { constants: Constants(&constants), ..Raster::new(program.shader()) })?;
        let (uniforms, ldr) = (cx.uniform(&self.settings), cx.view(io.ldr)?);
        let group = program.bind(cx, &pipeline, 0, |cx, name| {
            Ok(match name {
                "fxaa" => Some(uniforms.clone()),
                "ldr" => Some(ldr.clone().into()),
                "ldr_sampler" => Some(cx.sampler(SamplerDesc::LINEAR).into()),
                _ => None,
            })
        })?;
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }
}
