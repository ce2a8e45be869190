//! Mirrors of `wgsl/pass/bloom.wgsl`, `wgsl/pass/flare.wgsl` and `wgsl/effect/bloom.wgsl`.

use bytemuck::{Pod, Zeroable};

/// Settings of the first bloom pass, which extracts bright pixels.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BloomUniforms {
    /// Size of the area that the coordinates span, in texels of the source.
    pub span_px: [f32; 2],
    /// Position of the image in that area, in texels.
    pub begin_px: [f32; 2],
    /// Brightness threshold of the glow.
    pub threshold: f32,
    /// 1: a texel above the threshold glows with its full brightness. 0: only the excess over the threshold glows.
    pub hard: f32,
    /// Reciprocal of the maximum brightness of the glow; 0 for no limit.
    pub per_highlight: f32,
    /// 1: only texels above the threshold glow. 0: all texels glow.
    pub thresholds: f32,
    /// 1: reduces the weight of single bright texels. 0: weights all texels equally.
    pub fireflies: f32,
    /// Padding to 48 bytes; zero.
    pub _pad: [f32; 3],
}

/// Settings of a lens flare: ghosts, halo and star rays.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FlareUniforms {
    /// Aspect ratio, width over height.
    pub aspect: f32,
    /// Chromatic aberration: distance between red and blue, as a fraction of the image size.
    pub aberration: f32,
    /// Number of ghosts.
    pub ghosts: f32,
    /// Distance between ghosts, as a fraction of the distance to the center.
    pub ghost_spacing: f32,
    /// Brightness threshold of ghosts.
    pub ghost_threshold: f32,
    /// Radius of the halo, as a fraction of the height.
    pub halo_radius: f32,
    /// Thickness of the halo, as a fraction of the height; 0 for no halo.
    pub halo_thickness: f32,
    /// Brightness threshold of the halo.
    pub halo_threshold: f32,
    /// Step of the blur, in texels.
    pub axis: [f32; 2],
    /// Rotation of the star rays.
    pub turn: f32,
    /// 1: draws star rays. 0: leaves the flare unchanged.
    pub rays: f32,
    /// Scale from coordinates of the bloom texture to coordinates of the area in which the flare is centered.
    pub span_scale: [f32; 2],
    /// Offset that is added after `span_scale`.
    pub span_offset: [f32; 2],
}

/// Settings of the effect `bloom`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct BloomMixUniforms {
    /// Weight of the glow.
    pub glow: f32,
    /// Weight of the image.
    pub picture: f32,
    /// Weight of the flare.
    pub flare: f32,
    /// Factor on the lens dirt.
    pub dirt: f32,
    /// Position of the image in the area of the bloom texture, in pixels.
    pub begin_px: [f32; 2],
    /// Reciprocal of the size of that area, in 1/pixels.
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
