//! The built-in point-wise effects, in the order in which a frame applies them.

use framegraph_shaders as shaders;
use framegraph_wgpu::Effect;

const fn embedded(effect: shaders::Effect) -> Effect {
    Effect { name: effect.name, wgsl: effect.text }
}

/// What storing as Rgba16Float leaves. Override `RGBA16FLOAT_TOWARD_ZERO`.
pub const STORE_RGBA16FLOAT: Effect = embedded(shaders::Effect::STORE_RGBA16FLOAT);
/// What storing as Rg11b10Ufloat leaves. Override `RG11B10UFLOAT_TOWARD_ZERO`.
pub const STORE_RG11B10UFLOAT: Effect = embedded(shaders::Effect::STORE_RG11B10UFLOAT);
/// Exposure compensation. Binds `exposing`.
pub const EXPOSE: Effect = embedded(shaders::Effect::EXPOSE);
/// Darker corners. Binds `vignetting`.
pub const VIGNETTE: Effect = embedded(shaders::Effect::VIGNETTE);
/// Color grading. Binds `grading`.
pub const GRADE: Effect = embedded(shaders::Effect::GRADE);
/// The tone curve. Override `TONE_MAP`.
pub const TONE: Effect = embedded(shaders::Effect::TONE);
/// Codes of the target, with dither. Binds `encoding`; overrides `OUTPUT_ENCODED`, `LUMA_IN_ALPHA`.
pub const ENCODE: Effect = embedded(shaders::Effect::ENCODE);

/// `@binding` of the constants of [`EXPOSE`].
pub const EXPOSING: u32 = 16;
/// `@binding` of the constants of [`GRADE`].
pub const GRADING: u32 = 17;
/// `@binding` of the constants of [`VIGNETTE`].
pub const VIGNETTING: u32 = 18;
/// `@binding` of the constants of [`ENCODE`].
pub const ENCODING: u32 = 19;
