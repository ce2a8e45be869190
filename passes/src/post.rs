//! Post: what happens to a color between shading and the display, all of it point-wise.
//!
//! The effects are exposure, vignette, grading, tone curve and encoding with dither, in this order. A pass does all of them, or
//! one of several passes does its share. Where the plan inlines it, the pass hands the same effects to the shader that
//! makes the color.

use crate::effect;
use crate::world::World;
use framegraph::{DeclareError, Extent, Format, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View};
use framegraph_shaders::layout::{
    EncodingUniforms, ExposureUniforms, Grading, GradingUniforms, ToneMap, VignetteUniforms,
};
use framegraph_shaders::{Features, Module, library};
use framegraph_wgpu::Record;
use framegraph_wgpu::{Constants, Cx, Epilogue, Raster, RecordError, Rounding, StoreRounding};

/// Effects over the whole screen.
pub(crate) const POST: Module<'_> = library::pass("pass/post.wgsl").unwrap();

/// One of the effects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Stage {
    /// Exposure compensation.
    Exposure,
    /// Darker corners.
    Vignette,
    /// White balance, contrast, saturation.
    Grading,
    /// The tone curve.
    ToneMap,
    /// Codes of the target, with dither.
    Encode,
}

impl Stage {
    /// All of them, in their order.
    pub const ALL: [Self; 5] = [Self::Exposure, Self::Vignette, Self::Grading, Self::ToneMap, Self::Encode];

    /// Name of a pass that does nothing else.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Exposure => "exposure",
            Self::Vignette => "vignette",
            Self::Grading => "grading",
            Self::ToneMap => "tone_map",
            Self::Encode => "encode",
        }
    }
}

/// How the picture is to look.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// Exposure compensation in EV.
    pub compensation_ev: f32,
    /// By how many stops the corners are darker than the middle; 0 leaves the effect out.
    pub vignette_ev: f32,
    /// Color grading; neutral leaves the effect out.
    pub grading: Grading,
    /// The curve.
    pub tone_map: ToneMap,
    /// Amplitude of the dither: 1 is half a code either way, 0 is none.
    pub dither: f32,
}

impl Look {
    /// The stages that make a difference.
    pub fn stages(&self) -> impl Iterator<Item = Stage> + use<> {
        let (vignette, grading) = (self.vignette_ev > 0.0, self.grading != Grading::NEUTRAL);
        Stage::ALL.into_iter().filter(move |stage| match stage {
            Stage::Vignette => vignette,
            Stage::Grading => grading,
            _ => true,
        })
    }
}

/// From pre-exposed linear Rec.709 toward the display.
#[derive(Clone, Copy, Debug)]
pub struct Post {
    /// Scene-referred radiance times exposure, single-sampled, of the frame's size.
    pub hdr: Texture,
    /// Where the picture goes; new ones are eight bits a channel after the last stage, and of the input's kind before.
    pub into: Target,
    /// How the picture is to look.
    pub look: Look,
    /// The only stage, where each has a pass of its own.
    pub only: Option<Stage>,
    /// An edge filter follows: write encoded values with their luma in alpha.
    pub for_fxaa: bool,
    /// Where the pass is inlined, round its input as the device would on the way through a texture: the same bits as
    /// without inlining. None works on what was shaded, in 32 bits.
    pub stored: Option<StoreRounding>,
}

/// What the post pass reads and wrote.
#[derive(Clone, Copy, Debug)]
pub struct PostIo {
    hdr: View,
    /// The picture: sRGB encoded, by the target's format or (for an edge filter) by the shader; linear before the last
    /// stage.
    pub ldr: Texture,
}

impl Pass for Post {
    type Io = PostIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<PostIo, DeclareError> {
        pass.pointwise();
        let hdr = pass.same_pixel(self.hdr)?;
        let (name, format) = match self.only {
            Some(stage) if stage != Stage::Encode => (stage.name(), crate::color::HDR_FORMAT),
            _ => ("ldr", if self.for_fxaa { Format::Rgba8Unorm } else { Format::Rgba8UnormSrgb }),
        };
        let into = pass.target(self.into, name, TextureDesc::new(Extent::FRAME, format));
        Ok(PostIo { hdr, ldr: pass.color(into, Intent::Overwrite)? })
    }
}

impl Record<World> for Post {
    fn record(&self, io: &PostIo, world: &World, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let own = self.effects(io, world, cx)?;
        let program = world.programs.ending(&POST, &Features::NONE, "fs_main", &own.effects)?;
        let constants = Constants(&own.constants);
        let pipeline = cx.raster_pipeline(&Raster { constants, ..Raster::new(program.shader()) })?;
        let hdr = cx.view(io.hdr)?;
        let group = program.bind(cx, &pipeline, 0, |_, name| {
            Ok(if name == "hdr" {
                Some(hdr.clone().into())
            } else {
                effect::binding(name).and_then(|number| own.binding(number)).cloned()
            })
        })?;
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group, &[]);
        pass.draw(0..3, 0..1);
        Ok(())
    }

    fn epilogue(&self, io: &PostIo, world: &World, cx: &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError> {
        let mut all = self.rounding(cx)?;
        all.append(&self.effects(io, world, cx)?)?;
        Ok(Some(all))
    }
}

impl Post {
    /// The effects of this pass with their settings.
    fn effects(&self, io: &PostIo, world: &World, cx: &mut Cx<'_>) -> Result<Epilogue, RecordError> {
        let Self { look, only, for_fxaa, .. } = self;
        let flag = |on: bool| f64::from(u8::from(on));
        let mut all = Epilogue::default();
        for stage in look.stages().filter(|stage| only.is_none_or(|only| only == *stage)) {
            let (effect, constants, bindings) = match stage {
                Stage::Exposure => {
                    let uniforms = cx.uniform(&ExposureUniforms::new(look.compensation_ev));
                    (effect::EXPOSE, Vec::new(), vec![(effect::EXPOSING, uniforms)])
                }
                Stage::Vignette => {
                    let uniforms = cx.uniform(&VignetteUniforms::new(cx.frame_texels(), look.vignette_ev));
                    (effect::VIGNETTE, Vec::new(), vec![(effect::VIGNETTING, uniforms)])
                }
                Stage::Grading => {
                    let uniforms = cx.uniform(&GradingUniforms::new(&look.grading));
                    (effect::GRADE, Vec::new(), vec![(effect::GRADING, uniforms)])
                }
                Stage::ToneMap => (effect::TONE, vec![("TONE_MAP", look.tone_map.constant())], Vec::new()),
                Stage::Encode => {
                    let encoded = flag(!cx.format_of(io.ldr)?.is_srgb());
                    let constants = vec![("OUTPUT_ENCODED", encoded), ("LUMA_IN_ALPHA", flag(*for_fxaa))];
                    let uniforms = cx.uniform(&EncodingUniforms::new(look.dither, world.view.frame.frame_index));
                    (effect::ENCODE, constants, vec![(effect::ENCODING, uniforms)])
                }
            };
            all.append(&Epilogue { effects: vec![effect], constants, bindings })?;
        }
        Ok(all)
    }

    /// What the way through the texture that the epilogue does without would have done.
    fn rounding(&self, cx: &Cx<'_>) -> Result<Epilogue, RecordError> {
        let Some(stored) = self.stored else { return Ok(Epilogue::default()) };
        let format = cx.format_of(self.hdr)?;
        let (effect, constant) = match format {
            Format::Rgba16Float => (effect::STORE_RGBA16FLOAT, "RGBA16FLOAT_TOWARD_ZERO"),
            Format::Rg11b10Ufloat => (effect::STORE_RG11B10UFLOAT, "RG11B10UFLOAT_TOWARD_ZERO"),
            _ => return Err(unknown(format)),
        };
        let toward_zero = stored.of(format).ok_or_else(|| unknown(format))? == Rounding::TowardZero;
        let constants = vec![(constant, f64::from(u8::from(toward_zero)))];
        Ok(Epilogue { effects: vec![effect], constants, bindings: Vec::new() })
    }
}

fn unknown(format: Format) -> RecordError {
    RecordError::custom(format!(
        "how this device rounds when it stores {format:?} is not known; use Rgba16Float or Rg11b10Ufloat, or leave \
         `Settings::stored` out"
    ))
}
