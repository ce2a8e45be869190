//! Mirror of `wgsl/pass/dof.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::Vec4;

/// Lens and steps of depth of field.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DofUniforms {
    /// What z and w of clip space are made of.
    pub depth_row: Vec4,
    /// The largest radius before and behind what is in focus, in pixels.
    pub most_px: [f32; 2],
    /// One over the size of the picture, in 1/pixels.
    pub per_px: [f32; 2],
    /// What is in focus, in m.
    pub focus_m: f32,
    /// Diameter of what is infinitely far away, in pixels.
    pub scale_px: f32,
    /// Texels of the gather to a tile.
    pub tile_texels: f32,
    /// The last level there is.
    pub last_level: f32,
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(DofUniforms { depth_row, most_px, per_px, focus_m, scale_px, tile_texels, last_level })]
}
