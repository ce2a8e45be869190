//! The pass that adds frames up.

use super::jitter::weights;
use super::settings::{Clipping, ColorBox, TaaSettings};
use crate::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use crate::view::{CameraView, ViewId, Views};
use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Previous, Texture, View};
use framegraph_shaders::layout::TaaUniforms;
use framegraph_shaders::{Feature, Features, Module, library};
use framegraph_wgpu::{Cx, Record, RecordError, SamplerDesc};

/// Format of the sum: half floats, whatever the frame's radiance has, since sums in fewer bits stop short of what is added.
pub(super) const SUM_FORMAT: Format = Format::Rgba16Float;

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

/// Adds a frame of a view to the sum of those before. Of the world it needs [`Programs`] and the view's camera, which says how
/// the frame is jittered and from where the one before was seen ([`CameraView::after`], [`Views::again`]).
#[derive(Clone, Copy, Debug)]
pub struct Taa {
    /// The view.
    pub view: ViewId,
    /// Radiance times exposure.
    pub hdr: Texture,
    /// Reversed depth of one sample per texel, of the same size.
    pub depth: Texture,
    /// Where what moves was, from the pass [`Velocity`](crate::velocity::Velocity); none where nothing moves.
    pub velocity: Option<Texture>,
    /// The sum of the frames before.
    pub earlier: Previous,
    /// Where the sum goes.
    pub into: Texture,
    /// How.
    pub settings: TaaSettings,
}

/// What the pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct TaaIo {
    hdr: View,
    depth: View,
    velocity: Option<View>,
    earlier: View,
    /// The sum. In a frame without an earlier one it is this frame alone.
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
    /// Whether the sum is the mean of frames of which nothing differs but the jitter.
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
