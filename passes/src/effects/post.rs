//! Post: what happens to a color between shading and the display, all of it point-wise.
//!
//! The effects are bloom, exposure, vignette, edge fade, grading, tone curve and encoding with dither, in this order; a table takes
//! the place of grading and tone curve where that is asked for. A pass does all of them, or one of several passes does its
//! share. Where the plan inlines it, the pass hands the same effects to the shader that makes the color.

pub mod pixel_effects;
pub mod tone_resolve;

use crate::effects::bloom::BloomMix;
use crate::effects::color::surface::HDR_FORMAT;
use crate::error::PassError;
use crate::grading::{GradeBy, GradingTables, Look};
use crate::program::full_screen::FullScreen;
use crate::program::{Interface, ProgramDesc, Programs};
use crate::settings::frame_index::FrameIndex;
use framegraph::{DeclareError, Format, Intent, Pass, PassBuilder, Target, Texture, TextureDesc, View};
use framegraph_shaders::layout::{
    EdgeFade, EdgeFadeUniforms, EncodingUniforms, ExposureUniforms, Grading, GradingUniforms, ToneMap, VignetteUniforms,
};
use framegraph_shaders::reference::grade::Grade;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Epilogue, Record, RecordError, Rounding, SamplerDesc, SettingName, StoreRounding};

static SHADER: Module<'static> = library::pass("pass/post.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["hdr"]], constants: &[] };

/// One of the effects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PostEffect {
    /// What glows over the picture.
    Bloom,
    /// Exposure compensation.
    Exposure,
    /// Darker corners.
    Vignette,
    /// A color toward the edges.
    EdgeFade,
    /// White balance, contrast, saturation and what else changes colors.
    Grading,
    /// The tone curve.
    ToneMap,
    /// Grading, tone curve and encoding from a table.
    Table,
    /// Codes of the target, with dither.
    Encode,
}

impl PostEffect {
    /// All of them, in their order.
    pub const ALL: [Self; 8] = [
        Self::Bloom,
        Self::Exposure,
        Self::Vignette,
        Self::EdgeFade,
        Self::Grading,
        Self::ToneMap,
        Self::Table,
        Self::Encode,
    ];

    /// Name of a pass that does nothing else.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bloom => "bloom_mix",
            Self::Exposure => "exposure",
            Self::Vignette => "vignette",
            Self::EdgeFade => "edge_fade",
            Self::Grading => "grading",
            Self::ToneMap => "tone_map",
            Self::Table => "table",
            Self::Encode => "encode",
        }
    }
}

/// Parameters of the effects.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct PostSettings {
    /// Exposure compensation in EV, before the vignette. (That of grading comes after it.)
    pub compensation_ev: f32,
    /// By how many stops the corners are darker than the middle; 0 leaves the effect out.
    pub vignette_ev: f32,
    /// A color that the picture fades into toward its edges; none leaves the effect out.
    pub edge_fade: Option<EdgeFade>,
    /// Color grading and tone curve; neutral grading leaves that effect out.
    pub look: Look,
    /// Whether the look is computed or looked up.
    pub by: GradeBy,
    /// Amplitude of the dither: 1 is half a code either way, 0 is none.
    pub dither: f32,
}

impl PostSettings {
    /// Hill's curve of ACES and dither, nothing else.
    pub const DEFAULT: Self = Self {
        compensation_ev: 0.0,
        vignette_ev: 0.0,
        edge_fade: None,
        look: Look {
            grading: Grading::NEUTRAL,
            tone_map: ToneMap::Hill,
            luminance_scaling: false,
            gamut_mapping: false,
        },
        by: GradeBy::Direct,
        dither: 1.0,
    };

    /// The effects that make a difference, in their order; with what `blooms`, bloom too.
    pub fn effects(&self, blooms: bool) -> impl Iterator<Item = PostEffect> + use<> {
        let (vignette, fade, table) = (self.vignette_ev > 0.0, self.edge_fade.is_some(), self.by != GradeBy::Direct);
        let grading = self.look.grading != Grading::NEUTRAL;
        PostEffect::ALL.into_iter().filter(move |effect| match effect {
            PostEffect::Bloom => blooms,
            PostEffect::Vignette => vignette,
            PostEffect::EdgeFade => fade,
            PostEffect::Grading => grading && !table,
            PostEffect::ToneMap => !table,
            PostEffect::Table => table,
            PostEffect::Exposure | PostEffect::Encode => true,
        })
    }
}

impl Default for PostSettings {
    /// [`PostSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// From pre-exposed linear Rec.709 toward the display. Of the world it needs [`Programs`], the [`FrameIndex`] and
/// [`GradingTables`].
#[derive(Clone, Copy, Debug)]
pub struct Post {
    /// Scene-referred radiance times exposure, single-sampled.
    pub hdr: Texture,
    /// What glows, laid over it first. It is read at other pixels too: such a pass is not inlined.
    pub bloom: Option<BloomMix>,
    /// Where the picture goes; a new one has the size of `hdr`, eight bits a channel after the last effect, and half floats
    /// before.
    pub into: Target,
    /// Parameters of the effects.
    pub settings: PostSettings,
    /// The only effect, where each has a pass of its own.
    pub only: Option<PostEffect>,
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
    bloom: Option<MixViews>,
    /// What the target is seen through.
    view: Option<Format>,
    /// The picture: sRGB encoded, by the target's format or (for an edge filter) by the shader; linear before the last
    /// effect.
    pub ldr: Texture,
}

/// What the effect `bloom` reads: the glow; flare and dirt, or the glow again where there is none.
#[derive(Clone, Copy, Debug)]
struct MixViews {
    mix: BloomMix,
    read: [View; 3],
}

impl MixViews {
    fn declare(mix: BloomMix, pass: &mut PassBuilder<'_>) -> Result<Self, DeclareError> {
        let glow = pass.sampled(mix.glow.mip(0))?;
        let mut or_glow = |other: Option<Texture>| other.map_or(Ok(glow), |other| pass.sampled(other));
        Ok(Self { mix, read: [glow, or_glow(mix.flare)?, or_glow(mix.dirt)?] })
    }
}

impl Pass for Post {
    type Io = PostIo;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<PostIo, DeclareError> {
        let mix = self.bloom.filter(|_| self.only.is_none_or(|only| only == PostEffect::Bloom));
        let bloom = mix.map(|mix| MixViews::declare(mix, pass)).transpose()?;
        if bloom.is_none() {
            pass.pointwise();
        }
        let extent = pass.desc(self.hdr)?.extent;
        let hdr = pass.same_pixel(self.hdr)?;
        let (name, format) = match self.only {
            Some(effect) if effect != PostEffect::Encode => (effect.name(), HDR_FORMAT),
            _ => ("ldr", if self.for_fxaa { Format::Rgba8Unorm } else { Format::Rgba8UnormSrgb }),
        };
        let into = pass.target(self.into, name, TextureDesc::new(extent, format));
        Ok(PostIo { hdr, bloom, view: into.view_format(), ldr: pass.color(into, Intent::Overwrite)? })
    }
}

impl<W: AsRef<Programs> + AsRef<FrameIndex> + AsRef<GradingTables> + ?Sized> Record<W> for Post {
    fn record(&self, io: &PostIo, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let own = self.effects(io, *world.as_ref(), world.as_ref(), cx)?;
        let constants: Vec<f64> = own.constants.iter().map(|(_, value)| *value).collect();
        let hdr = Some(cx.view(io.hdr)?.into());
        let provided: Vec<_> = [hdr].into_iter().chain(own.bindings.iter().map(|(_, b)| Some(b.clone()))).collect();
        let program = ProgramDesc { epilogue: &own, ..ProgramDesc::new(&SHADER, &INTERFACE) };
        FullScreen { constants: &constants, ..FullScreen::new(program, &[&provided]) }.draw(world.as_ref(), cx)
    }

    fn epilogue(&self, io: &PostIo, world: &W, cx: &mut Cx<'_>) -> Result<Option<Epilogue>, RecordError> {
        let mut all = self.rounding(cx)?;
        all.append(&self.effects(io, *world.as_ref(), world.as_ref(), cx)?)?;
        Ok(Some(all))
    }
}

impl Post {
    /// The effects of this pass with their settings.
    fn effects(
        &self,
        io: &PostIo,
        FrameIndex(frame): FrameIndex,
        tables: &GradingTables,
        cx: &mut Cx<'_>,
    ) -> Result<Epilogue, RecordError> {
        let Self { settings, only, for_fxaa, .. } = self;
        let look = &settings.look;
        if settings.by == GradeBy::Direct {
            look.is_direct(tables.extras()).map_err(PassError::from)?;
        }
        let flag = |on: bool| f64::from(u8::from(on));
        let mut all = Epilogue::default();
        for effect in settings.effects(io.bloom.is_some()).filter(|effect| only.is_none_or(|only| only == *effect)) {
            let (effect, constants, bindings) = match effect {
                PostEffect::Bloom => {
                    let Some(MixViews { mix, read }) = io.bloom else { continue };
                    let constants = vec![
                        (const { SettingName::new("LENS_FLARE") }, flag(mix.flare.is_some())),
                        (const { SettingName::new("LENS_DIRT") }, flag(mix.dirt.is_some())),
                    ];
                    let [glow, flare, dirt] = read.map(|view| cx.view(view));
                    let bindings = vec![
                        (const { SettingName::new("blooming") }, cx.uniform(&mix.uniforms(cx.texels(io.hdr)?))),
                        (const { SettingName::new("bloom_glow") }, glow?.into()),
                        (const { SettingName::new("bloom_sampler") }, cx.sampler(SamplerDesc::LINEAR).into()),
                        (const { SettingName::new("bloom_flare") }, flare?.into()),
                        (const { SettingName::new("bloom_dirt") }, dirt?.into()),
                    ];
                    (pixel_effects::BLOOM, constants, bindings)
                }
                PostEffect::Exposure => {
                    let uniforms = cx.uniform(&ExposureUniforms::new(settings.compensation_ev));
                    (pixel_effects::EXPOSE, Vec::new(), vec![(const { SettingName::new("exposing") }, uniforms)])
                }
                PostEffect::Vignette => {
                    let uniforms = cx.uniform(&VignetteUniforms::new(cx.texels(io.hdr)?, settings.vignette_ev));
                    (pixel_effects::VIGNETTE, Vec::new(), vec![(const { SettingName::new("vignetting") }, uniforms)])
                }
                PostEffect::EdgeFade => {
                    let fade = settings.edge_fade.unwrap_or(EdgeFade::DEFAULT);
                    let uniforms = cx.uniform(&EdgeFadeUniforms::new(cx.texels(io.hdr)?, &fade));
                    (pixel_effects::EDGE_FADE, Vec::new(), vec![(const { SettingName::new("fading") }, uniforms)])
                }
                PostEffect::Grading => {
                    let grade = Grade::new(&look.grading, look.tone_map.graded_in_rec2020());
                    let night = (const { SettingName::new("NIGHT") }, flag(grade.night > 0.0));
                    let uniforms = cx.uniform(&GradingUniforms::new(&grade));
                    (pixel_effects::GRADE, vec![night], vec![(const { SettingName::new("grading") }, uniforms)])
                }
                PostEffect::ToneMap => (pixel_effects::TONE, tone_constants(look), Vec::new()),
                PostEffect::Table => {
                    let GradeBy::Table(desc) = settings.by else { continue };
                    let table = tables.get(cx.gpu(), look, desc).map_err(PassError::from)?;
                    let sampler = cx.sampler(SamplerDesc::LINEAR).into();
                    let (effect, names) = if table.cube {
                        (
                            pixel_effects::LOOK_UP,
                            const { [SettingName::new("grading_table"), SettingName::new("grading_sampler")] },
                        )
                    } else {
                        (
                            pixel_effects::LOOK_UP_CURVES,
                            const { [SettingName::new("grading_curves"), SettingName::new("curves_sampler")] },
                        )
                    };
                    (effect, Vec::new(), names.into_iter().zip([table.view.into(), sampler]).collect())
                }
                PostEffect::Encode => {
                    let written = io.view.map_or_else(|| cx.format_of(io.ldr), Ok)?;
                    let constants = vec![
                        (const { SettingName::new("OUTPUT_ENCODED") }, flag(!written.is_srgb())),
                        (
                            const { SettingName::new("INPUT_ENCODED") },
                            flag(settings.by != GradeBy::Direct || look.is_encoded()),
                        ),
                        (const { SettingName::new("LUMA_IN_ALPHA") }, flag(*for_fxaa)),
                    ];
                    let uniforms = cx.uniform(&EncodingUniforms::new(settings.dither, frame));
                    (pixel_effects::ENCODE, constants, vec![(const { SettingName::new("encoding") }, uniforms)])
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
            Format::Rgba16Float => {
                (pixel_effects::STORE_RGBA16FLOAT, const { SettingName::new("RGBA16FLOAT_TOWARD_ZERO") })
            }
            Format::Rg11b10Ufloat => {
                (pixel_effects::STORE_RG11B10UFLOAT, const { SettingName::new("RG11B10UFLOAT_TOWARD_ZERO") })
            }
            _ => return Err(PassError::UnknownRounding { format }.into()),
        };
        let rounding = stored.of(format).ok_or(PassError::UnknownRounding { format })?;
        let constants = vec![(constant, f64::from(rounding == Rounding::TowardZero))];
        Ok(Epilogue { effects: vec![effect], constants, bindings: Vec::new() })
    }
}

/// Values of the overrides of the effect `tone`. Every curve that a shader has, has a number.
fn tone_constants(look: &Look) -> Vec<(SettingName, f64)> {
    let flag = |on: bool| f64::from(u8::from(on));
    let generic = look.tone_map.generic();
    vec![
        (const { SettingName::new("TONE_MAP") }, look.tone_map.number().map_or(0.0, f64::from)),
        (const { SettingName::new("GENERIC_CONTRAST") }, generic.x),
        (const { SettingName::new("GENERIC_INPUT") }, generic.y),
        (const { SettingName::new("GENERIC_OUTPUT") }, generic.z),
        (const { SettingName::new("BY_LUMINANCE") }, flag(look.luminance_scaling)),
        (const { SettingName::new("INTO_GAMUT") }, flag(look.gamut_mapping)),
    ]
}
