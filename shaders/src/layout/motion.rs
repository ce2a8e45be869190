//! Mirror of the struct of `wgsl/pass/velocity.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::Mat4;

/// Transforms of an instance in this and the previous frame; one element per instance.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct MotionUniforms {
    /// Model-to-clip matrix of this frame, without jitter.
    pub clip_from_model: Mat4,
    /// Model-to-clip matrix of the previous frame, without jitter.
    pub earlier_clip_from_model: Mat4,
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(MotionUniforms { clip_from_model, earlier_clip_from_model })]
}
