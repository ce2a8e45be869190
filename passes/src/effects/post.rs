//! Post-processing: point-wise effects between shading and the display.
//!
//! The effects are bloom, exposure, vignette, edge fade, grading, tone curve, and encoding with dither, in this order.
//! A lookup table can replace grading and tone curve. One pass applies all effects, or each has a pass of its own. If
//! the plan inlines the pass, the shader that computes the color applies the effects.

mod fields;
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
    EdgeFade, EdgeFadeUniforms, EncodingUniforms, ExposureUniforms, Grading, GradingUniforms, VignetteUniforms,
};
use framegraph_shaders::reference::grade::Grade;
use framegraph_shaders::{Module, library};
use framegraph_wgpu::{Cx, Epilogue, Record, RecordError, Rounding, SamplerDesc, SettingName, StoreRounding};

static SHADER: Module<'static> = library::pass("pass/post.wgsl").unwrap();

static INTERFACE: Interface = Interface { groups: &[&["hdr"]], constants: &[] };

/// A point-wise effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PostEffect {
    /// Adds bloom.
    Bloom,
    /// Applies exposure compensation.
    Exposure,
    /// Darkens the corners.
    Vignette,
    /// Fades to a color toward the edges.
    EdgeFade,
    /// Grades colors: white balance, contrast, saturation and others.
    Grading,
    /// Applies the tone curve.
    ToneMap,
    /// Applies grading, tone curve and encoding from a lookup table.
    Table,
    /// Encodes for the target, with dither.
    Encode,
}

impl PostEffect {
    /// All effects, in the order of application.
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

    /// Returns the name of a pass with only this effect.
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

/// Settings of post-processing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct PostSettings {
    /// Exposure compensation in EV, before the vignette. The compensation of grading is applied after it.
    pub compensation_ev: f32,
    /// Darkening of the corners relative to the center, in stops; 0 disables the vignette.
    pub vignette_ev: f32,
    /// Color to which the picture fades toward its edges; `None` disables the fade.
    pub edge_fade: Option<EdgeFade>,
    /// Color grading and tone curve; neutral grading is skipped.
    pub look: Look,
    /// Evaluation of the look: per pixel or from a lookup table.
    pub by: GradeBy,
    /// Amplitude of the dither: 1 is ± half an 8-bit step, 0 disables it.
    pub dither: f32,
}

impl PostSettings {
    /// Hill's fit of the ACES curve, and dither.
    pub const DEFAULT: Self = Self {
        compensation_ev: 0.0,
        vignette_ev: 0.0,
        edge_fade: None,
        look: Look::DEFAULT,
        by: GradeBy::Direct,
        dither: 1.0,
    };

    /// Returns the effects with a visible result, in order; includes bloom if `blooms`.
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
    /// Returns [`PostSettings::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Applies post-processing to pre-exposed linear Rec.709. Uses [`Programs`], the [`FrameIndex`] and [`GradingTables`]
/// of the world.
#[derive(Clone, Copy, Debug)]
pub struct Post {
    /// Pre-exposed radiance with one sample.
    pub hdr: Texture,
    /// Bloom, applied first. It is read at other pixels too, so the pass is not inlined.
    pub bloom: Option<BloomMix>,
    /// Target. A new texture has the size and layers of `hdr`, with 8 bits per channel after the last effect and half floats
    /// before.
    pub into: Target,
    /// Settings of the effects.
    pub settings: PostSettings,
    /// Effect to apply, if each effect has a separate pass; `None` applies all of them.
    pub only: Option<PostEffect>,
    /// Writes encoded values with luma in alpha, for an edge filter that follows.
    pub for_fxaa: bool,
    /// If inlined, rounds the input as a store to its texture would, so the result is bit-identical to no inlining.
    /// `None` uses the shaded color in 32 bits.
    pub stored: Option<StoreRounding>,
}

/// Handles of the pass.
#[derive(Clone, Copy, Debug)]
pub struct PostIo {
    hdr: View,
    bloom: Option<MixViews>,
    /// Format of the view through which the target is written.
    view: Option<Format>,
    /// The picture: sRGB encoded, by the target's format or, for an edge filter, by the shader. Linear before the last
    /// effect.
    pub ldr: Texture,
}

/// Inputs of the bloom effect: the glow, flare and dirt. The glow stands in for missing textures.
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
        let TextureDesc { extent, layers, .. } = pass.desc(self.hdr)?;
        let hdr = pass.same_pixel(self.hdr)?;
        let (name, format) = match self.only {
            Some(effect) if effect != PostEffect::Encode => (effect.name(), HDR_FORMAT),
            _ => ("ldr", if self.for_fxaa { Format::Rgba8Unorm } else { Format::Rgba8UnormSrgb }),
        };
        let into = pass.target(self.into, name, TextureDesc::new(extent, format).layers(layers));
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
    /// Returns the effects of this pass with their settings.
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

    /// Returns an effect that rounds as the store to the skipped texture would have done.
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

/// Returns the overrides of the effect `tone`. Every curve with shader code has a number.
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
