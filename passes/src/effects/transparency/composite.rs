//! Blended surfaces over what is behind them: the last pass of every technique that needs no order.

use crate::effects::depth::resolve::can_read_samples;
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Epilogue, Record, RecordError};

static SHADER: Module<'static> = library::pass("pass/blended.wgsl").unwrap();

/// Each picture is read as one of two variables, by its samples.
static INTERFACE: Interface = Interface {
    groups: &[&[
        "behind",
        "behind_samples",
        "accumulated",
        "accumulated_samples",
        "let_through",
        "let_through_samples",
    ]],
    constants: &["SUMS"],
};

/// What the passes over blended surfaces left.
#[derive(Clone, Copy, Debug)]
pub enum BlendedSums {
    /// Those of [`Weighted`](super::Weighted).
    Weighted {
        /// Weighted colors.
        accumulated: Texture,
        /// What all surfaces together let through.
        transmittance: Texture,
    },
    /// Those of [`MomentShade`](super::MomentShade).
    Moments {
        /// Weighted colors.
        accumulated: Texture,
        /// The sum of absorbances of each sample.
        absorbance: Texture,
    },
    /// Those of [`PeelLayer`](super::PeelLayer).
    Peeled {
        /// Color of all layers, and in alpha what they let through.
        layers: Texture,
    },
}

/// Puts blended surfaces over the radiance of what is behind them. A point-wise effect that follows can be inlined.
#[derive(Clone, Copy, Debug)]
pub struct BlendedComposite {
    /// Radiance of what does not blend, of each sample.
    pub behind: Texture,
    /// Blended surfaces.
    pub sums: BlendedSums,
    /// Where the radiance goes, of one sample per texel.
    pub into: Target,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct BlendedCompositeIo {
    read: [View; 3],
    count: u8,
    /// Radiance with everything in it, of each sample; `hdr` itself at one sample per texel.
    pub samples: Texture,
    /// Scene-referred radiance times exposure with everything in it, single-sampled.
    pub hdr: Texture,
}

impl Pass for BlendedComposite {
    type Io = BlendedCompositeIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<BlendedCompositeIo, DeclareError> {
        pass.takes_epilogue();
        let behind = pass.desc(self.behind)?;
        let (accumulated, through) = match self.sums {
            BlendedSums::Weighted { accumulated, transmittance } => (accumulated, Some(transmittance)),
            BlendedSums::Moments { accumulated, absorbance } => (accumulated, Some(absorbance)),
            BlendedSums::Peeled { layers } => (layers, None),
        };
        let [hdr, accumulated] = [pass.same_pixel(self.behind)?, pass.same_pixel(accumulated)?];
        let read = [hdr, accumulated, through.map_or(Ok(accumulated), |through| pass.same_pixel(through))?];
        let desc = TextureDesc::new(behind.extent, behind.format);
        let hdr = pass.target(self.into, "hdr", desc);
        // The slots before have the radiance and the sums: so all passes share a step where a device reads them there.
        if behind.samples == 1 {
            let hdr = pass.color_at(4, hdr, Intent::Overwrite)?;
            return Ok(BlendedCompositeIo { read, count: 1, samples: hdr, hdr });
        }
        let samples = pass.texture("hdr_samples", desc.samples(behind.samples));
        let samples = pass.color_at(4, samples, Intent::Overwrite)?;
        let hdr = pass.resolve(samples, hdr.texture())?;
        Ok(BlendedCompositeIo { read, count: behind.samples, samples, hdr })
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for BlendedComposite {
    fn record(&self, io: &BlendedCompositeIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        can_read_samples(io.count, cx.gpu())?;
        let mut epilogue = Epilogue::default();
        for (_, own) in cx.epilogues()? {
            epilogue.append(own)?;
        }
        let mut provided = Vec::new();
        for view in io.read {
            let view = cx.view(view)?;
            provided.extend([Some(view.clone().into()), Some(view.into())]);
        }
        provided.extend(epilogue.bindings.iter().map(|(_, binding)| Some(binding.clone())));
        let sums = match self.sums {
            BlendedSums::Weighted { .. } => 0.0,
            BlendedSums::Moments { .. } => 1.0,
            BlendedSums::Peeled { .. } => 2.0,
        };
        let constants: Vec<f64> =
            [sums].into_iter().chain(epilogue.constants.iter().map(|(_, value)| *value)).collect();
        let fragment = Some(if io.count == 1 { "fs_main" } else { "fs_samples" });
        let program = ProgramDesc { fragment, epilogue: &epilogue, ..ProgramDesc::new(&SHADER, &INTERFACE) };
        FullScreen { constants: &constants, ..FullScreen::new(program, &[&provided]) }.draw(world.as_ref(), cx)
    }
}
