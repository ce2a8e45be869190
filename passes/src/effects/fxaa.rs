//! FXAA: fast approximate anti-aliasing of a finished picture.

use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View};
use framegraph_shaders::layout::FxaaUniforms;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError, SamplerDesc};

static SHADER: Module<'static> = library::pass("pass/fxaa.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["fxaa", "ldr", "ldr_sampler"]], constants: &["OUTPUT_ENCODED"] };

/// Filters a picture with luma in its alpha channel. Uses [`Programs`] of the world.
#[derive(Clone, Copy, Debug)]
pub struct Fxaa {
    /// The picture, sRGB encoded in a linear format, luma in alpha.
    pub ldr: Texture,
    /// Target; a new texture has the picture's size and format Rgba8UnormSrgb.
    pub into: Target,
    /// Thresholds and sharpness.
    pub settings: FxaaUniforms,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct FxaaIo {
    ldr: View,
    /// The filtered picture.
    pub output: Texture,
}

impl Pass for Fxaa {
    type Io = FxaaIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<FxaaIo, DeclareError> {
        let extent = pass.desc(self.ldr)?.extent;
        let ldr = pass.sampled(self.ldr)?;
        let into = pass.target(self.into, "antialiased", TextureDesc::new(extent, Format::Rgba8UnormSrgb));
        Ok(FxaaIo { ldr, output: pass.color(into, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for Fxaa {
    fn record(&self, io: &FxaaIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let srgb = cx.targets().colors[0].is_some_and(Format::is_srgb);
        let ldr = cx.view(io.ldr)?.into();
        let provided = [cx.uniform(&self.settings), ldr, cx.sampler(SamplerDesc::LINEAR).into()].map(Some);
        let draw = FullScreen::new(ProgramDesc::new(&SHADER, &INTERFACE), &[]);
        FullScreen { constants: &[f64::from(!srgb)], groups: &[&provided], ..draw }.draw(world.as_ref(), cx)
    }
}
