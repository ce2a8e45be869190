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
    /// Creates settings that brighten by `compensation_ev` stops.
    pub fn new(compensation_ev: f32) -> Self {
        Self { scale: compensation_ev.exp2(), _pad: [0.0; 3] }
    }
}

/// Settings of the effect `vignette`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct VignetteUniforms {
    /// Center of the image in pixels.
    pub centre_px: [f32; 2],
    /// Reciprocal of the distance from the center to a corner, in 1/pixels.
    pub per_corner_px: f32,
    /// Strength of the falloff: 2^(stops/2) - 1 for corners darker by that many stops, 0 for none.
    pub falloff: f32,
}

impl VignetteUniforms {
    /// Creates settings for an image of `size_px` whose corners are darker than its center by `corner_ev` stops, at
    /// least 0.
    pub fn new(size_px: [u32; 2], corner_ev: f32) -> Self {
        let centre_px = size_px.map(|side| side as f32 * 0.5);
        let corner_px = centre_px[0].hypot(centre_px[1]).max(0.5);
        Self { centre_px, per_corner_px: corner_px.recip(), falloff: (corner_ev.max(0.0) * 0.5).exp2() - 1.0 }
    }
}

/// Vignette that fades into a color toward the edges, with Filament's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct EdgeFade {
    /// Distance from the center at which the fade begins, 0…1.
    pub middle: f32,
    /// From a rounded rectangle (0) over an oval (0.5) to a circle (1).
    pub roundness: f32,
    /// Softness of the fade, 0…1.
    pub feather: f32,
    /// Factor on light at the edges; linear Rec.709.
    pub color: [f32; 3],
    /// Multiple to which the sides of the buffer are rounded up, with the image at its bottom left. The fade spans this
    /// buffer. 1 uses the image itself. Filament renders into multiples of 16.
    pub multiple_px: u32,
}

impl EdgeFade {
    /// Filament's defaults: 0.5 for every parameter, fading to black.
    pub const DEFAULT: Self = Self { middle: 0.5, roundness: 0.5, feather: 0.5, color: [0.0; 3], multiple_px: 1 };
}

/// Settings of the effect `edge_fade`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct EdgeFadeUniforms {
    /// Scale of both axes, scale of the horizontal axis, exponent of the corners, exponent of the falloff.
    pub shape: [f32; 4],
    /// Copy of [`EdgeFade::color`].
    pub color: [f32; 3],
    /// Padding; zero.
    pub _pad0: f32,
    /// Center of the fade, in pixels.
    pub middle_px: [f32; 2],
    /// Reciprocal of the size of the fade, in 1/pixels.
    pub per_px: [f32; 2],
}

impl EdgeFadeUniforms {
    /// Creates settings for an image of `size_px`; values out of range are clamped.
    pub fn new(size_px: [u32; 2], fade: &EdgeFade) -> Self {
        let [width, height] =
            size_px.map(|side| side.max(1).next_multiple_of(fade.multiple_px.clamp(1, 1 << 16)) as f32);
        let [middle, roundness, feather] = [fade.middle, fade.roundness, fade.feather].map(|x| x.clamp(0.0, 1.0));
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        let (oval, circle) = (roundness.min(0.5) * 2.0, (roundness.max(0.5) - 0.5) * 2.0);
        let corners = (1.0 - oval) * 6.0 + oval;
        let scale = (1.0 - middle) * mix(2.2, 3.0, oval) * (1.0 - 0.1 * feather);
        let radius = corners * mix(1.0 + 4.0 * (1.0 - feather), 1.0, oval.sqrt());
        let aspect = mix(1.0, width / height, circle);
        Self {
            shape: [scale, aspect, radius, 5.0 * feather],
            color: fade.color,
            _pad0: 0.0,
            middle_px: [0.5 * width, size_px[1] as f32 - 0.5 * height],
            per_px: [width.recip(), height.recip()],
        }
    }
}

/// Settings of the effect `encode`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct EncodingUniforms {
    /// Amplitude of the dither in half steps of the target, 0…1.
    pub dither: f32,
    /// Largest integer value of the target: 255 for 8 bits per channel.
    pub dither_levels: f32,
    /// Frame number, which shifts the dither pattern.
    pub frame_index: u32,
    /// Padding to 16 bytes; zero.
    pub _pad: u32,
}

impl EncodingUniforms {
    /// Creates settings for a target with 8 bits per channel.
    pub fn new(dither: f32, frame_index: u32) -> Self {
        Self { dither, dither_levels: 255.0, frame_index, _pad: 0 }
    }
}

/// Settings of the FXAA pass.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FxaaUniforms {
    /// Divisor of the second tap pair's distance: larger values filter a shorter part of the edge. 8 is usual.
    pub edge_sharpness: f32,
    /// Minimum contrast that is filtered, as a share of the largest luma nearby.
    pub edge_threshold: f32,
    /// Minimum contrast that is filtered, in luma 0…1.
    pub edge_threshold_min: f32,
    /// Weight of the unfiltered pixel in the result, 0…1.
    pub centre_weight: f32,
}

impl Default for FxaaUniforms {
    /// Returns Filament's values.
    fn default() -> Self {
        Self { edge_sharpness: 8.0, edge_threshold: 0.08, edge_threshold_min: 0.04, centre_weight: 0.25 }
    }
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![
        layout_of!(ExposureUniforms { scale, _pad }),
        layout_of!(VignetteUniforms { centre_px, per_corner_px, falloff }),
        layout_of!(EdgeFadeUniforms { shape, color, _pad0, middle_px, per_px }),
        layout_of!(EncodingUniforms { dither, dither_levels, frame_index, _pad }),
        layout_of!(FxaaUniforms { edge_sharpness, edge_threshold, edge_threshold_min, centre_weight }),
    ]
}
