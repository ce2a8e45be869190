//! Built-in point-wise effects, in the order of a frame.

use framegraph_shaders::library;
use framegraph_wgpu::Effect;

/// Rounds as a store to Rgba16Float. Override `RGBA16FLOAT_TOWARD_ZERO`.
pub const STORE_RGBA16FLOAT: Effect =
    Effect { name: "store_rgba16float", wgsl: library::text("effect/store_rgba16float.wgsl").unwrap() };
/// Rounds as a store to Rg11b10Ufloat. Override `RG11B10UFLOAT_TOWARD_ZERO`.
pub const STORE_RG11B10UFLOAT: Effect =
    Effect { name: "store_rg11b10ufloat", wgsl: library::text("effect/store_rg11b10ufloat.wgsl").unwrap() };
/// Adds bloom. Binds `blooming`, `bloom_glow`, `bloom_sampler`, `bloom_flare` and `bloom_dirt`; overrides
/// `LENS_FLARE`, `LENS_DIRT`.
pub const BLOOM: Effect = Effect { name: "bloom", wgsl: library::text("effect/bloom.wgsl").unwrap() };
/// Applies exposure compensation. Binds `exposing`.
pub const EXPOSE: Effect = Effect { name: "expose", wgsl: library::text("effect/expose.wgsl").unwrap() };
/// Darkens the corners. Binds `vignetting`.
pub const VIGNETTE: Effect = Effect { name: "vignette", wgsl: library::text("effect/vignette.wgsl").unwrap() };
/// Fades to a color toward the edges. Binds `fading`.
pub const EDGE_FADE: Effect = Effect { name: "edge_fade", wgsl: library::text("effect/edge_fade.wgsl").unwrap() };
/// Grades colors. Binds `grading`. Override `NIGHT`.
pub const GRADE: Effect = Effect { name: "grade", wgsl: library::text("effect/grade.wgsl").unwrap() };
/// Applies the tone curve. Overrides `TONE_MAP`, `GENERIC_CONTRAST`, `GENERIC_INPUT`, `GENERIC_OUTPUT`, `BY_LUMINANCE`,
/// `INTO_GAMUT`.
pub const TONE: Effect = Effect { name: "tone", wgsl: library::text("effect/tone.wgsl").unwrap() };
/// Grades, applies the tone curve and encodes with a 3D table. Binds `grading_table` and `grading_sampler`.
pub const LOOK_UP: Effect = Effect { name: "look_up", wgsl: library::text("effect/look_up.wgsl").unwrap() };
/// Grades, applies the tone curve and encodes with a 1D table. Binds `grading_curves` and `curves_sampler`.
pub const LOOK_UP_CURVES: Effect =
    Effect { name: "look_up_curves", wgsl: library::text("effect/look_up_curves.wgsl").unwrap() };
/// Encodes for the target, with dither. Binds `encoding`; overrides `OUTPUT_ENCODED`, `INPUT_ENCODED`,
/// `LUMA_IN_ALPHA`.
pub const ENCODE: Effect = Effect { name: "encode", wgsl: library::text("effect/encode.wgsl").unwrap() };
