//! Mirrors of the uniforms of `wgsl/effect/` and `wgsl/pass/fxaa.wgsl`.

use bytemuck::{Pod, Zeroable};

/// Settings of the effect `expose`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ExposureUniforms {
    /// Factor on the pre-exposed color: 2^(exposure compensation in EV).
    pub scale: f32,
    /// Padding to 16 bytes; zero.
    pub _pad: [f32; 3],
}

impl ExposureUniforms {
    /// Brighter by `compensation_ev` stops.
    pub fn new(compensation_ev: f32) -> Self {
        Self { scale: compensation_ev.exp2(), _pad: [0.0; 3] }
    }
}

/// Settings of the effect `vignette`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct VignetteUniforms {
    /// Center of the picture in pixels.
    pub centre_px: [f32; 2],
    /// One over the distance from the center to a corner, in 1/pixels.
    pub per_corner_px: f32,
    /// Strength of the falloff: 2^(stops/2) - 1 for corners darker by that many stops, 0 for none.
    pub falloff: f32,
}

impl VignetteUniforms {
    /// Corners of a picture of `size_px` that are darker than its middle by `corner_ev` stops, at least 0.
    pub fn new(size_px: [u32; 2], corner_ev: f32) -> Self {
        let centre_px = size_px.map(|side| side as f32 * 0.5);
        let corner_px = centre_px[0].hypot(centre_px[1]).max(0.5);
        Self { centre_px, per_corner_px: corner_px.recip(), falloff: (corner_ev.max(0.0) * 0.5).exp2() - 1.0 }
    }
}

/// Settings of the effect `encode`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct EncodingUniforms {
    /// Amplitude of the dither in half codes of the target, 0…1.
    pub dither: f32,
    /// Largest code of the target: 255 for 8 bits a channel.
    pub dither_levels: f32,
    /// Number of the frame, which shifts the dither pattern.
    pub frame_index: u32,
    /// Padding to 16 bytes; zero.
    pub _pad: u32,
}

impl EncodingUniforms {
    /// For a target of eight bits a channel.
    pub fn new(dither: f32, frame_index: u32) -> Self {
        Self { dither, dither_levels: 255.0, frame_index, _pad: 0 }
    }
}

/// Settings of the FXAA pass.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FxaaUniforms {
    /// Divides the reach of the second pair of taps: larger filters along less of the edge. 8 is usual.
    pub edge_sharpness: f32,
    /// Least contrast that is filtered, as a share of the largest luma nearby.
    pub edge_threshold: f32,
    /// Least contrast that is filtered, in luma 0…1.
    pub edge_threshold_min: f32,
    /// Weight of the unfiltered pixel in the result, 0…1.
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
    /// Clamped to 0…1.
    Linear,
    /// ACES 1.0 as fitted by Hill.
    #[default]
    Aces,
    /// Narkowicz' per-channel curve, Filament's FILMIC.
    Filmic,
    /// Khronos PBR Neutral.
    Neutral,
    /// ACES with its input brighter by 1/0.6: Filament's default.
    AcesLegacy,
    /// Clamped to 0…1 in the primaries of Rec.2020: Filament's LINEAR.
    Linear2020,
}

impl ToneMap {
    /// All curves.
    pub const ALL: [Self; 6] =
        [Self::Linear, Self::Aces, Self::Filmic, Self::Neutral, Self::AcesLegacy, Self::Linear2020];

    /// Value of the override `TONE_MAP`.
    pub const fn constant(self) -> f64 {
        match self {
            Self::Linear => 0.0,
            Self::Aces => 1.0,
            Self::Filmic => 2.0,
            Self::Neutral => 3.0,
            Self::AcesLegacy => 4.0,
            Self::Linear2020 => 5.0,
        }
    }

    /// Name on a command line.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Linear => "linear",
            Self::Aces => "aces",
            Self::Filmic => "filmic",
            Self::Neutral => "neutral",
            Self::AcesLegacy => "aces-legacy",
            Self::Linear2020 => "linear-2020",
        }
    }

    /// The curve of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|curve| curve.name() == name)
    }
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![
        layout_of!(ExposureUniforms { scale, _pad }),
        layout_of!(VignetteUniforms { centre_px, per_corner_px, falloff }),
        layout_of!(EncodingUniforms { dither, dither_levels, frame_index, _pad }),
        layout_of!(FxaaUniforms { edge_sharpness, edge_threshold, edge_threshold_min, centre_weight }),
    ]
}
