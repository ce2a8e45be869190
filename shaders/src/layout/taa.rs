//! Mirror of the struct of `wgsl/pass/taa.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec4};

/// Settings of temporal anti-aliasing.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TaaUniforms {
    /// Clip space of this frame to clip space of the previous frame, both without jitter.
    pub earlier_clip_from_clip: Mat4,
    /// Weights of a texel and its neighbors, row by row from the top left; the last three are unused.
    pub weights: [Vec4; 3],
    /// Weight of this frame in the blend; 1 without a history.
    pub feedback: f32,
    /// Half width of the variance clipping box, in standard deviations.
    pub variance_gamma: f32,
    /// Exposure of this frame divided by that of the previous frame.
    pub exposure_ratio: f32,
    /// Padding to 16 bytes; zero.
    pub _pad: f32,
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(TaaUniforms { earlier_clip_from_clip, weights, feedback, variance_gamma, exposure_ratio, _pad })]
}
