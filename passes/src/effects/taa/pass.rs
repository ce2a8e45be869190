//! The pass that accumulates frames.

use super::jitter::weights;
use super::settings::{Clipping, ColorBox, TaaSettings};
use crate::gpu_scene::view::{CameraView, ViewId, Views};
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Previous, Texture, View};
use framegraph_shaders::layout::TaaUniforms;
use framegraph_shaders::{Feature, Features, Module, library};
use framegraph_wgpu::{Cx, Record, RecordError, SamplerDesc};

/// Format of the history: half floats for any radiance format, since fewer bits stop accumulating early.
pub(crate) const SUM_FORMAT: Format = Format::Rgba16Float;

static SHADER: Module<'static> = library::pass("pass/taa.wgsl").unwrap();

static INTERFACE: Interface = Interface {
    groups: &[&["temporal", "hdr", "depth", "earlier", "earlier_sampler", "velocity"]],
    constants: &[
        "BOX",
        "CLIPPING",
        "YCOCG",
        "FILTER_HISTORY",
        "FILTER_INPUT",
        "PREVENT_FLICKERING",
        "REPROJECT",
        "COMPRESS",
    ],
};

/// Accumulates a frame of a view into its history. Uses [`Programs`] and the view's camera of the world: its jitter
/// and previous camera ([`CameraView::after`], [`Views::again`]).
#[derive(Clone, Copy, Debug)]
pub struct Taa {
    /// The view.
    pub view: ViewId,
    /// Pre-exposed radiance.
    pub hdr: Texture,
    /// Reversed depth with one sample per pixel, of the same size.
    pub depth: Texture,
    /// Motion vectors of the pass [`Velocity`](crate::effects::taa::velocity::Velocity); `None` if nothing moves.
    pub velocity: Option<Texture>,
    /// History of the previous frames.
    pub earlier: Previous,
    /// Target of the new history.
    pub into: Texture,
    /// Settings.
    pub settings: TaaSettings,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct TaaIo {
    hdr: View,
    depth: View,
    velocity: Option<View>,
    earlier: View,
    /// The accumulated radiance. Without an earlier frame it is this frame alone.
    pub sum: Texture,
}

impl Pass for Taa {
    type Io = TaaIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<TaaIo, DeclareError> {
        let [hdr, depth, earlier] = [pass.sampled(self.hdr)?, pass.sampled(self.depth)?, pass.sampled(self.earlier)?];
        let velocity = self.velocity.map(|velocity| pass.sampled(velocity)).transpose()?;
        Ok(TaaIo { hdr, depth, velocity, earlier, sum: pass.color(self.into, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + AsRef<Views> + ?Sized> Record<W> for Taa {
    fn record(&self, io: &TaaIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let views: &Views = world.as_ref();
        let view = &views.get(self.view)?.view;
        let velocity = io.velocity.map(|velocity| cx.view(velocity)).transpose()?;
        let provided = [
            cx.uniform(&self.uniforms(view, cx.is_valid(self.earlier)?)),
            cx.view(io.hdr)?.into(),
            cx.view(io.depth)?.into(),
            cx.view(io.earlier)?.into(),
            cx.sampler(SamplerDesc::LINEAR).into(),
        ]
        .map(Some);
        let [settings, hdr, depth, earlier, sampler] = provided;
        let provided = [settings, hdr, depth, earlier, sampler, velocity.map(Into::into)];
        let features = Features::NONE.with_if(Feature::VELOCITY, io.velocity.is_some());
        let TaaSettings { filter_history, filter_input, ycocg, prevent_flickering, reproject, .. } = self.settings;
        let color_box = match self.settings.color_box {
            ColorBox::Bounds => 0.0,
            ColorBox::Variance => 1.0,
            ColorBox::Both => 2.0,
        };
        let clipping = match self.settings.clipping {
            _ if self.rests(view) => 2.0,
            Clipping::Accurate => 0.0,
            Clipping::Clamp => 1.0,
            Clipping::None => 2.0,
        };
        let switches = [ycocg, filter_history, filter_input, prevent_flickering, reproject, !self.rests(view)];
        let [ycocg, history, input, steady, reproject, compress] = switches.map(f64::from);
        let constants = [color_box, clipping, ycocg, history, input, steady, reproject, compress];
        let program = ProgramDesc { features: &features, ..ProgramDesc::new(&SHADER, &INTERFACE) };
        let draw = FullScreen::new(program, &[]);
        FullScreen { constants: &constants, groups: &[&provided], ..draw }.draw(world.as_ref(), cx)
    }
}

impl Taa {
    /// Returns true if only the jitter differs between frames, so that the history is their mean.
    fn rests(&self, view: &CameraView) -> bool {
        self.settings.converge && view.still_frames > 1
    }

    fn uniforms(&self, view: &CameraView, valid: bool) -> TaaUniforms {
        let stand = view.stand();
        let (_, exposure_ratio) = stand.to_earlier(view.earlier);
        TaaUniforms {
            earlier_clip_from_clip: stand.steady_clip_to_earlier(view.earlier),
            weights: weights(view.jitter_px, self.settings.filter_width.into()),
            feedback: match valid {
                true if self.rests(view) => 1.0 / view.still_frames as f32,
                true => self.settings.feedback,
                false => 1.0,
            },
            variance_gamma: self.settings.variance_gamma,
            exposure_ratio,
            ..TaaUniforms::default()
        }
    }
}
