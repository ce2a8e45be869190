//! Mirror of the struct of `wgsl/pass/reflection.wgsl`.

use super::occlusion::Projection;
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2};

/// Settings of reflections in what the picture shows.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct ReflectionUniforms {
    /// Of the view.
    pub projection: Projection,
    /// View space of this frame to clip space of the frame before.
    pub earlier_clip_from_view: Mat4,
    /// How far behind its front a surface is still met, in m.
    pub thickness_m: f32,
    /// Where rays begin, in m along them.
    pub bias_m: f32,
    /// Where they end.
    pub reach_m: f32,
    /// Texels from step to step.
    pub stride: f32,
    /// Perceptual roughness from which on nothing is traced.
    pub most_roughness: f32,
    /// Exposure of this frame over that of the frame before.
    pub exposure_ratio: f32,
    /// Padding.
    pub _pad: Vec2,
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
        _pad,
    })]
}
