//! Contrast-adaptive sharpening, after upscaling and after temporal anti-aliasing.

use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Target, Texture, View};
use framegraph_shaders::layout::SharpenUniforms;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError};

static SHADER: Module<'static> = library::pass("pass/sharpen.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["sharpening", "picture"]], constants: &["DECODE"] };

/// Number of times that sharpness 0 halves the strength of sharpness 1, as in Filament.
const MAX_STOPS: f32 = 2.0;

/// Sharpens a picture depending on local contrast (RCAS of FSR 1.0). Uses [`Programs`] of the world.
#[derive(Clone, Copy, Debug)]
pub struct Sharpen {
    /// Radiance, or sRGB encoded colors in a linear format.
    pub picture: Texture,
    /// Target; a new texture has the size and format of the picture. Encoded colors are decoded for sRGB formats.
    pub into: Target,
    /// Strength, 0 to 1; at 0, sharpens a quarter as much as at 1.
    pub sharpness: f32,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct SharpenIo {
    picture: View,
    /// The sharpened picture.
    pub sharp: Texture,
}

impl Pass for Sharpen {
    type Io = SharpenIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<SharpenIo, DeclareError> {
        let desc = pass.desc(self.picture)?;
        let picture = pass.sampled(self.picture)?;
        let into = pass.target(self.into, "sharpened", desc);
        Ok(SharpenIo { picture, sharp: pass.color(into, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for Sharpen {
    fn record(&self, io: &SharpenIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let decode = cx.targets().colors[0].is_some_and(Format::is_srgb);
        let strength = (-MAX_STOPS * (1.0 - self.sharpness.clamp(0.0, 1.0))).exp2();
        let settings = SharpenUniforms { strength, ..SharpenUniforms::default() };
        let provided = [cx.uniform(&settings), cx.view(io.picture)?.into()].map(Some);
        let draw = FullScreen::new(ProgramDesc::new(&SHADER, &INTERFACE), &[]);
        FullScreen { constants: &[f64::from(decode)], groups: &[&provided], ..draw }.draw(world.as_ref(), cx)
    }
}
