//! Mirrors of the uniforms of `wgsl/pass/post.wgsl` and `wgsl/pass/fxaa.wgsl`.

use bytemuck::{Pod, Zeroable};

/// Settings of the post pass.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct PostUniforms {
    /// Factor on the pre-exposed input: 2^(compensation in EV).
    pub exposure_scale: f32,
    /// Amplitude of the dither, 0…1.
    pub dither: f32,
    /// Codes of the target less one.
    pub dither_levels: f32,
    /// Moves the dither pattern.
    pub frame_index: u32,
}

impl Default for PostUniforms {
    /// No compensation, dithered for eight bits.
    fn default() -> Self {
        Self { exposure_scale: 1.0, dither: 1.0, dither_levels: 255.0, frame_index: 0 }
    }
}

/// Settings of the FXAA pass.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FxaaUniforms {
    /// Shrinks the span.
    pub edge_sharpness: f32,
    /// Least contrast as a share of the brightest luma.
    pub edge_threshold: f32,
    /// Least contrast at all.
    pub edge_threshold_min: f32,
    /// Share of the unfiltered pixel kept.
    pub centre_weight: f32,
}

impl Default for FxaaUniforms {
    /// Filament's values.
    fn default() -> Self {
        Self { edge_sharpness: 8.0, edge_threshold: 0.08, edge_threshold_min: 0.04, centre_weight: 0.25 }
    }
}

/// A tone curve of `wgsl/lib/tone_map.wgsl`, the value of the override `TONE_MAP`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ToneMap {
    /// Cut off at one.
    Linear,
    /// ACES 1.0 as fitted by Hill.
    #[default]
    Aces,
    /// Narkowicz' per-channel curve, Filament's FILMIC.
    Filmic,
    /// Khronos PBR Neutral.
    Neutral,
}

impl ToneMap {
    /// All curves.
    pub const ALL: [Self; 4] = [Self::Linear, Self::Aces, Self::Filmic, Self::Neutral];

    /// Value of the override `TONE_MAP`.
    pub const fn constant(self) -> f64 {
        match self {
            Self::Linear => 0.0,
            Self::Aces => 1.0,
            Self::Filmic => 2.0,
            Self::Neutral => 3.0,
        }
    }

    /// Name on a command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Aces => "aces",
            Self::Filmic => "filmic",
            Self::Neutral => "neutral",
        }
    }

    /// The curve of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|curve| curve.name() == name)
    }
}
