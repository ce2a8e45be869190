//! Mirrors of `wgsl/pass/bloom.wgsl`, `wgsl/pass/flare.wgsl` and `wgsl/effect/bloom.wgsl`.

use bytemuck::{Pod, Zeroable};

/// What glows, and where the picture is.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BloomUniforms {
    /// Size of what the coordinates span, in texels of the picture.
    pub span_px: [f32; 2],
    /// Where in it the picture begins, in texels.
    pub begin_px: [f32; 2],
    /// Brightness from which on something glows.
    pub threshold: f32,
    /// 1: all of what is bright enough glows. 0: what is above the threshold.
    pub hard: f32,
    /// One over the brightness that bright glow nears; 0 for none.
    pub per_highlight: f32,
    /// 1: only what is above the threshold glows. 0: everything does.
    pub thresholds: f32,
    /// 1: single bright texels count less. 0: they count fully.
    pub fireflies: f32,
    /// Padding to 48 bytes; zero.
    pub _pad: [f32; 3],
}

/// Ghosts, halo and rays of a lens flare.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FlareUniforms {
    /// Width over height.
    pub aspect: f32,
    /// How far apart red and blue are, in shares of the picture.
    pub aberration: f32,
    /// How many ghosts.
    pub ghosts: f32,
    /// Between ghosts, in shares of the way to the middle.
    pub ghost_spacing: f32,
    /// Brightness from which on there are ghosts.
    pub ghost_threshold: f32,
    /// In shares of the height.
    pub halo_radius: f32,
    /// In shares of the height; 0: there is none.
    pub halo_thickness: f32,
    /// Brightness from which on there is a halo.
    pub halo_threshold: f32,
    /// From texel to texel of the blur, in texels.
    pub axis: [f32; 2],
    /// How far rays are turned.
    pub turn: f32,
    /// 1: there are rays. 0: all is left.
    pub rays: f32,
    /// Factor from coordinates of what glows to those of the span that the flare is centered in.
    pub span_scale: [f32; 2],
    /// Summand after the factor.
    pub span_offset: [f32; 2],
}

/// Settings of the effect `bloom`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BloomMixUniforms {
    /// What of the glow is added.
    pub glow: f32,
    /// What of the picture is left.
    pub picture: f32,
    /// What of the flare is added.
    pub flare: f32,
    /// Factor on the dirt.
    pub dirt: f32,
    /// Where in what the glow spans the picture begins, in pixels.
    pub begin_px: [f32; 2],
    /// One over the size of what the glow spans, in 1/pixels.
    pub per_px: [f32; 2],
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![
        layout_of!(BloomUniforms { span_px, begin_px, threshold, hard, per_highlight, thresholds, fireflies, _pad }),
        layout_of!(FlareUniforms {
            aspect,
            aberration,
            ghosts,
            ghost_spacing,
            ghost_threshold,
            halo_radius,
            halo_thickness,
            halo_threshold,
            axis,
            turn,
            rays,
            span_scale,
            span_offset,
        }),
        layout_of!(BloomMixUniforms { glow, picture, flare, dirt, begin_px, per_px }),
    ]
}
