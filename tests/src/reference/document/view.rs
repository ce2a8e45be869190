//! Processing of the picture in Filament's terms: anti-aliasing, color, effects.

use super::occlusion::Ao;
use serde::Deserialize;
use serde_json::{Map, Value};

/// Processing of the picture. Options of effects that are not implemented are kept unparsed.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct View {
    /// True if any processing is enabled.
    #[serde(default)]
    pub post_processing: bool,
    /// Anti-aliasing of the final picture.
    #[serde(default)]
    pub anti_aliasing: AntiAliasing,
    /// Multisampling.
    pub msaa: Option<Msaa>,
    /// Temporal anti-aliasing.
    pub taa: Option<Taa>,
    /// Color grading.
    pub color_grading: Option<ColorGrading>,
    /// Ambient occlusion.
    pub ao: Option<Ao>,
    /// Screen-space reflections.
    pub ssr: Option<Ssr>,
    /// Bloom.
    pub bloom: Option<Bloom>,
    /// Fog.
    pub fog: Option<Fog>,
    /// Vignette.
    pub vignette: Option<Vignette>,
}

/// Screen-space reflections.
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
    /// Unknown options.
    #[serde(flatten)]
    pub unknown: Map<String, Value>,
}

/// Anti-aliasing of the final picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum AntiAliasing {
    /// No anti-aliasing.
    #[default]
    None,
    /// FXAA.
    Fxaa,
}

/// Multisampling.
#[derive(Clone, Debug, Deserialize)]
#[serde(untagged)]
pub enum Msaa {
    /// Four samples if true, otherwise one.
    On(bool),
    /// Number of samples.
    Samples(u32),
    /// Filament's options.
    Options(MsaaOptions),
}

/// Filament's multisampling options.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
pub struct MsaaOptions {
    /// True if enabled.
    #[serde(default)]
    pub enabled: bool,
    /// Number of samples.
    pub sample_count: Option<u32>,
    /// True for a custom resolve.
    pub custom_resolve: Option<bool>,
}

impl Msaa {
    /// Returns the number of samples.
    pub fn samples(&self) -> u32 {
        match self {
            Self::On(on) => 1 + 3 * u32::from(*on),
            Self::Samples(count) => *count,
            Self::Options(MsaaOptions { enabled: false, .. }) => 1,
            Self::Options(options) => options.sample_count.unwrap_or(4),
        }
    }
}

/// Temporal anti-aliasing.
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
    /// Unknown options.
    #[serde(flatten)]
    pub unknown: Map<String, Value>,
}

/// Shape of the color box that limits the history.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[allow(missing_docs, reason = "Filament's names")]
pub enum TaaBox {
    Aabb,
    Variance,
    AabbVariance,
}

/// Method of limiting the history.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
#[allow(missing_docs, reason = "Filament's names")]
pub enum TaaClipping {
    Accurate,
    Clamp,
    None,
}

/// Sequence of jitter positions.
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

/// Tone curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "SCREAMING_SNAKE_CASE")]
pub enum ToneMapping {
    /// Clamped linear values.
    Linear,
    /// ACES 1.0.
    Aces,
    /// ACES 1.0, brighter by 1/0.6: Filament's default.
    #[default]
    AcesLegacy,
    /// Narkowicz' curve.
    Filmic,
    /// Display range: one color per stop.
    DisplayRange,
}

/// Size of the color grading table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum GradingQuality {
    /// 16 entries per axis, 10 bits.
    Low,
    /// 32 entries per axis, 10 bits: Filament's default.
    Medium,
    /// 32 entries per axis, half floats.
    High,
    /// 64 entries per axis, half floats.
    Ultra,
}

/// Number format of the color grading table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum GradingFormat {
    /// 10-bit integers.
    Integer,
    /// Tolerance for half floats.
    Float,
}

/// Color grading.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
pub struct ColorGrading {
    /// Tone curve.
    #[serde(default, rename = "tone_mapping")]
    pub tone_mapping: ToneMapping,
    /// Size and format of the table.
    pub quality: Option<GradingQuality>,
    /// Format of the table, which overrides the quality's.
    pub format: Option<GradingFormat>,
    /// Exposure compensation, in EV.
    pub exposure: Option<f64>,
    /// Desaturation in the dark, 0…1.
    pub night_adaptation: Option<f64>,
    /// Temperature and tint, −1…1.
    pub white_balance: Option<[f64; 2]>,
    /// Matrix rows for the contributions of red, green and blue.
    pub channel_mixer: Option<[[f64; 3]; 3]>,
    /// Colors of shadows, midtones and highlights, then their ranges.
    pub shadows_midtones_highlights: Option<[[f64; 4]; 4]>,
    /// Slope, offset and power, applied to the logarithm.
    pub slope_offset_power: Option<[[f64; 3]; 3]>,
    /// Contrast around middle gray, 0…2.
    pub contrast: Option<f64>,
    /// Saturation that affects red less, 0…2.
    pub vibrance: Option<f64>,
    /// Saturation, 0…2.
    pub saturation: Option<f64>,
    /// Shadow gamma, midpoint and highlight slope per channel.
    pub curves: Option<[[f64; 3]; 3]>,
    /// True if the tone curve scales luminance instead of each channel.
    pub luminance_scaling: Option<bool>,
    /// True for gamut mapping after the tone curve.
    pub gamut_mapping: Option<bool>,
}

/// Bloom.
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
    /// Strength of lens dirt; ignored, since statements have no dirt texture.
    pub dirt_strength: Option<f64>,
}

/// Blending of bloom and picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum BlendMode {
    /// Adds bloom to the picture.
    Add,
    /// Interpolates between picture and bloom.
    Interpolate,
}

/// Quality of bloom's downsampling.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
#[allow(missing_docs, reason = "Filament's names")]
pub enum BloomQuality {
    Low,
    Medium,
    High,
    Ultra,
}

/// Fog.
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

/// Vignette.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "camelCase")]
pub struct Vignette {
    /// True if enabled.
    #[serde(default)]
    pub enabled: bool,
    /// Distance from the center at which it starts, 0…1.
    pub mid_point: Option<f64>,
    /// Roundness from a rectangle to a circle, 0…1.
    pub roundness: Option<f64>,
    /// Softness, 0…1.
    pub feather: Option<f64>,
    /// Color of the edges; the fourth number is ignored.
    pub color: Option<[f64; 4]>,
}
