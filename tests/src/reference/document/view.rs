//! What becomes of the light: antialiasing, color, effects, in Filament's terms.

use super::occlusion::Ao;
use serde::Deserialize;
use serde_json::{Map, Value};

/// What becomes of the light. Effects that are not built are kept as they are.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct View {
    /// Anything at all.
    #[serde(default)]
    pub post_processing: bool,
    /// Softens edges of the finished picture.
    #[serde(default)]
    pub anti_aliasing: AntiAliasing,
    /// Samples of each pixel.
    pub msaa: Option<Msaa>,
    /// Samples of former frames.
    pub taa: Option<Taa>,
    /// Color.
    pub color_grading: Option<ColorGrading>,
    /// Ambient occlusion.
    pub ao: Option<Ao>,
    /// Reflections of what the picture shows.
    pub ssr: Option<Ssr>,
    /// Glare.
    pub bloom: Option<Bloom>,
    /// Haze.
    pub fog: Option<Fog>,
    /// Darker corners.
    pub vignette: Option<Vignette>,
}

/// Reflections of what the picture shows.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
#[allow(missing_docs, reason = "Filament's names; lengths in m, the stride in texels")]
pub struct Ssr {
    #[serde(default)]
    pub enabled: bool,
    pub thickness: Option<f64>,
    pub bias: Option<f64>,
    pub max_distance: Option<f64>,
    pub stride: Option<f64>,
    /// Options that are not known.
    #[serde(flatten)]
    pub unknown: Map<String, Value>,
}

/// Softens edges of the finished picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum AntiAliasing {
    /// Nothing does.
    #[default]
    None,
    /// FXAA.
    Fxaa,
}

/// Samples of each pixel.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Msaa {
    /// Four, or one.
    On(bool),
    /// So many.
    Samples(u32),
    /// Filament's options.
    Options(MsaaOptions),
}

/// Filament's options.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
pub struct MsaaOptions {
    /// On.
    #[serde(default)]
    pub enabled: bool,
    /// How many.
    pub sample_count: Option<u32>,
    /// A resolve of its own.
    pub custom_resolve: Option<bool>,
}

impl Msaa {
    /// How many.
    pub fn samples(&self) -> u32 {
        match self {
            Self::On(on) => 1 + 3 * u32::from(*on),
            Self::Samples(count) => *count,
            Self::Options(MsaaOptions { enabled: false, .. }) => 1,
            Self::Options(options) => options.sample_count.unwrap_or(4),
        }
    }
}

/// Samples of former frames.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(rename_all = "camelCase")]
#[allow(missing_docs, reason = "Filament's names; widths in pixels")]
pub struct Taa {
    #[serde(default)]
    pub enabled: bool,
    pub filter_width: Option<f64>,
    pub feedback: Option<f64>,
    pub lod_bias: Option<f64>,
    pub sharpness: Option<f64>,
    #[serde(default)]
    pub upscaling: bool,
    pub filter_history: Option<bool>,
    pub filter_input: Option<bool>,
    #[serde(rename = "useYCoCg")]
    pub use_ycocg: Option<bool>,
    pub box_type: Option<TaaBox>,
    pub box_clipping: Option<TaaClipping>,
    pub jitter_pattern: Option<TaaJitter>,
    pub variance_gamma: Option<f64>,
    pub prevent_flickering: Option<bool>,
    pub history_reprojection: Option<bool>,
    /// Options that are not known.
    #[serde(flatten)]
    pub unknown: Map<String, Value>,
}

/// The box that former frames are held to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[allow(missing_docs, reason = "Filament's names")]
pub enum TaaBox {
    Aabb,
    Variance,
    AabbVariance,
}

/// How they are held to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[allow(missing_docs, reason = "Filament's names")]
pub enum TaaClipping {
    Accurate,
    Clamp,
    None,
}

/// Places within pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[allow(missing_docs, reason = "Filament's names")]
pub enum TaaJitter {
    #[serde(rename = "RGSS_X4")]
    Rgss4,
    #[serde(rename = "UNIFORM_HELIX_X4")]
    Helix4,
    #[serde(rename = "HALTON_23_X8")]
    Halton8,
    #[serde(rename = "HALTON_23_X16")]
    Halton16,
    #[serde(rename = "HALTON_23_X32")]
    Halton32,
}

/// A tone curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum ToneMapping {
    /// Cut off.
    Linear,
    /// ACES 1.0.
    Aces,
    /// The same, brighter by 1/0.6: what Filament does if not told.
    #[default]
    AcesLegacy,
    /// Narkowicz' curve.
    Filmic,
    /// A color for each stop.
    DisplayRange,
}

/// Size of the table that colors are looked up in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum GradingQuality {
    /// 16 entries a side, of ten bits.
    Low,
    /// 32, of ten bits: what Filament does if not told.
    Medium,
    /// 32, of half floats.
    High,
    /// 64, of half floats.
    Ultra,
}

/// Numbers of that table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum GradingFormat {
    /// Ten bits.
    Integer,
    /// Half floats.
    Float,
}

/// Color.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
pub struct ColorGrading {
    /// The curve.
    #[serde(default, rename = "tone_mapping")]
    pub tone_mapping: ToneMapping,
    /// Size and numbers of the table.
    pub quality: Option<GradingQuality>,
    /// Numbers of the table, whatever its size.
    pub format: Option<GradingFormat>,
    /// In EV.
    pub exposure: Option<f64>,
    /// Loss of color in the dark, 0…1.
    pub night_adaptation: Option<f64>,
    /// Temperature and tint, −1…1.
    pub white_balance: Option<[f64; 2]>,
    /// Rows of a matrix: what red, green and blue become.
    pub channel_mixer: Option<[[f64; 3]; 3]>,
    /// Colors by brightness, and in the last place where they begin and end.
    pub shadows_midtones_highlights: Option<[[f64; 4]; 4]>,
    /// Of the logarithm.
    pub slope_offset_power: Option<[[f64; 3]; 3]>,
    /// About grey, 0…2.
    pub contrast: Option<f64>,
    /// Saturation of reds more than of others, 0…2.
    pub vibrance: Option<f64>,
    /// 0…2.
    pub saturation: Option<f64>,
    /// By channel: exponent of shadows, middle, slope of highlights.
    pub curves: Option<[[f64; 3]; 3]>,
    /// Of the tone curve.
    pub luminance_scaling: Option<bool>,
    /// Of the tone curve.
    pub gamut_mapping: Option<bool>,
}

/// Glare.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
#[allow(missing_docs, reason = "Filament's names; thresholds in exposed light, lengths in shares of the picture")]
pub struct Bloom {
    #[serde(default)]
    pub enabled: bool,
    pub strength: Option<f64>,
    pub resolution: Option<f64>,
    pub levels: Option<f64>,
    pub blend_mode: Option<BlendMode>,
    pub threshold: Option<bool>,
    pub highlight: Option<f64>,
    pub quality: Option<BloomQuality>,
    pub lens_flare: Option<bool>,
    pub starburst: Option<bool>,
    pub chromatic_aberration: Option<f64>,
    pub ghost_count: Option<f64>,
    pub ghost_spacing: Option<f64>,
    pub ghost_threshold: Option<f64>,
    pub halo_thickness: Option<f64>,
    pub halo_radius: Option<f64>,
    pub halo_threshold: Option<f64>,
    /// There is no texture in a statement: a factor on nothing.
    pub dirt_strength: Option<f64>,
}

/// How glare is laid over the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum BlendMode {
    /// Added.
    Add,
    /// In the picture's place.
    Interpolate,
}

/// How the picture is made smaller for glare.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
#[allow(missing_docs, reason = "Filament's names")]
pub enum BloomQuality {
    Low,
    Medium,
    High,
    Ultra,
}

/// Haze.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
#[allow(missing_docs, reason = "Filament's names; lengths in m, density and falloff in 1/m")]
pub struct Fog {
    #[serde(default)]
    pub enabled: bool,
    pub distance: Option<f64>,
    pub density: Option<f64>,
    pub height: Option<f64>,
    pub height_falloff: Option<f64>,
    pub color: Option<[f64; 3]>,
    pub maximum_opacity: Option<f64>,
    pub cut_off_distance: Option<f64>,
    pub in_scattering_start: Option<f64>,
    pub in_scattering_size: Option<f64>,
    pub fog_color_from_ibl: Option<bool>,
}

/// The picture fades toward its edges.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
pub struct Vignette {
    /// On.
    #[serde(default)]
    pub enabled: bool,
    /// How far from the middle it begins, 0…1.
    pub mid_point: Option<f64>,
    /// From a rectangle to a circle, 0…1.
    pub roundness: Option<f64>,
    /// Softness, 0…1.
    pub feather: Option<f64>,
    /// What the edges become; the fourth number is not used.
    pub color: Option<[f64; 4]>,
}
