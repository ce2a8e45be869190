//! Mirror of the struct of `wgsl/pass/reflection.wgsl`.

use super::occlusion::Projection;
use bytemuck::{Pod, Zeroable};
use glam::Mat4;

/// Settings of screen-space reflections.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ReflectionUniforms {
    /// Projection of the view.
    pub projection: Projection,
    /// View space of this frame to clip space of the previous frame.
    pub earlier_clip_from_view: Mat4,
    /// Thickness assumed behind visible surfaces, in m.
    pub thickness_m: f32,
    /// Distance along the ray at which tracing begins, in m.
    pub bias_m: f32,
    /// Distance along the ray at which tracing ends, in m.
    pub reach_m: f32,
    /// Distance between steps, in texels.
    pub stride: f32,
    /// Maximum perceptual roughness that is traced.
    pub most_roughness: f32,
    /// Exposure of this frame divided by that of the previous frame.
    pub exposure_ratio: f32,
    /// Number of levels of depth bounds.
    pub bounds_levels: i32,
    /// Padding.
    pub _pad: f32,
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(ReflectionUniforms {
        projection,
        earlier_clip_from_view,
        thickness_m,
        bias_m,
        reach_m,
        stride,
        most_roughness,
        exposure_ratio,
        bounds_levels,
        _pad,
    })]
}
