//! Mirror of the struct of `wgsl/pass/taa.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec4};

/// Settings of temporal anti-aliasing.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct TaaUniforms {
    /// Clip space of this frame to that of the frame before, both without jitter.
    pub earlier_clip_from_clip: Mat4,
    /// Weights of a texel and its neighbors, row by row from the top left; three are unused.
    pub weights: [Vec4; 3],
    /// Share of this frame in the sum; 1 where there is none before.
    pub feedback: f32,
    /// Deviations that a box by variance is wide to either side.
    pub variance_gamma: f32,
    /// Exposure of this frame over that of the frame before.
    pub exposure_ratio: f32,
    /// Padding.
    pub _pad: f32,
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(TaaUniforms { earlier_clip_from_clip, weights, feedback, variance_gamma, exposure_ratio, _pad })]
}
