//! Sharpening by contrast: after upscaling, and after anti-aliasing over time.

use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Target, Texture, View};
use framegraph_shaders::layout::SharpenUniforms;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError};

static SHADER: Module<'static> = library::pass("pass/sharpen.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["sharpening", "picture"]], constants: &["DECODE"] };

/// How many halvings of the strength no sharpness is; all of it is none. Filament's scale.
const MAX_STOPS: f32 = 2.0;

/// Sharpens a picture by its own contrast (RCAS of FSR 1.0). Needs no more of the world than [`Programs`].
#[derive(Clone, Copy, Debug)]
pub struct Sharpen {
    /// Radiance, or codes encoded as sRGB in a linear format.
    pub picture: Texture,
    /// Where the result goes; a new one is as the picture. Codes that go into an sRGB format are decoded for it.
    pub into: Target,
    /// How much, 0 to 1; even 0 sharpens by a quarter of what 1 does.
    pub sharpness: f32,
}

/// What the pass reads and wrote.
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
