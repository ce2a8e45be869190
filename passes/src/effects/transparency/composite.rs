//! Composites blended surfaces over everything behind them: the last pass of every order-independent technique.

use crate::effects::depth::resolve::can_read_samples;
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View};
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Epilogue, Record, RecordError};

static SHADER: Module<'static> = library::pass("pass/blended.wgsl").unwrap();

/// The shader reads each texture as one of two variables, depending on its sample count.
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

/// Results of the passes over blended surfaces.
#[derive(Clone, Copy, Debug)]
pub enum BlendedSums {
    /// Results of [`Weighted`](super::Weighted).
    Weighted {
        /// Weighted colors.
        accumulated: Texture,
        /// Product of the transmittances of all surfaces.
        transmittance: Texture,
    },
    /// Results of [`MomentShade`](super::MomentShade).
    Moments {
        /// Weighted colors.
        accumulated: Texture,
        /// Sum of absorbances of each sample.
        absorbance: Texture,
    },
    /// Results of [`PeelLayer`](super::PeelLayer).
    Peeled {
        /// Color of all layers, and their transmittance in alpha.
        layers: Texture,
    },
}

/// Composites blended surfaces over the radiance behind them. Later point-wise effects can be inlined into it.
#[derive(Clone, Copy, Debug)]
pub struct BlendedComposite {
    /// Radiance of surfaces that do not blend, of each sample.
    pub behind: Texture,
    /// Results of the passes over blended surfaces.
    pub sums: BlendedSums,
    /// Target of the radiance, with one sample per texel.
    pub into: Target,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct BlendedCompositeIo {
    read: [View; 3],
    count: u8,
    /// Radiance of each sample, including blended surfaces; the same as `hdr` at one sample per texel.
    pub samples: Texture,
    /// Pre-exposed radiance with one sample, including blended surfaces.
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
        // Earlier slots hold radiance and sums, so all passes share a step on devices that read attachments in place.
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
