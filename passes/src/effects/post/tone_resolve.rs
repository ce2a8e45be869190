//! MSAA resolve weighted by tone mapping.

use crate::effects::depth::resolve::can_read_samples;
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Intent, Pass, PassBuilder, Texture, TextureDesc, View};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Record, RecordError};

static SHADER: Module<'static> = library::pass("pass/tone_resolve.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["hdr_samples"]], constants: &["SAMPLES"] };

/// Resolves multisampled radiance with the weight 1 / (1 + brightest channel) per sample (Karis, "Tone mapping", 2013).
/// Approximates the mean of displayed colors instead of radiance, so edges against bright lights stay smooth. Uses
/// [`Programs`] of the world.
///
/// Samples are stored and read back, while a device's own resolve keeps them in the tile. If post-processing is inlined
/// into the color pass, it grades each sample before the resolve, which is as smooth and needs neither.
#[derive(Clone, Copy, Debug)]
pub struct ToneResolve {
    /// Multisampled radiance.
    pub samples: Texture,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct ToneResolveIo {
    samples: View,
    count: u8,
    /// Radiance with one sample, of the same size and format.
    pub hdr: Texture,
}

impl Pass for ToneResolve {
    type Io = ToneResolveIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<ToneResolveIo, DeclareError> {
        let desc = pass.desc(self.samples)?;
        if desc.samples == 1 {
            return Err(pass.error("the radiance has one sample per texel", "read it as it is"));
        }
        let samples = pass.sampled(self.samples)?;
        let hdr = pass.texture("hdr", TextureDesc::new(desc.extent, desc.format));
        Ok(ToneResolveIo { samples, count: desc.samples, hdr: pass.color(hdr, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for ToneResolve {
    fn record(&self, io: &ToneResolveIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        can_read_samples(io.count, cx.gpu())?;
        let provided = [Some(cx.view(io.samples)?.into())];
        let draw = FullScreen::new(ProgramDesc::new(&SHADER, &INTERFACE), &[]);
        FullScreen { constants: &[f64::from(io.count)], groups: &[&provided], ..draw }.draw(world.as_ref(), cx)
    }
}
