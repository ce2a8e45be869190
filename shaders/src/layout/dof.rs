//! Mirror of `wgsl/pass/dof.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::Vec4;

/// Settings of depth of field.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct DofUniforms {
    /// Coefficients of z and w in clip space, from which distance is computed.
    pub depth_row: Vec4,
    /// Maximum radius of the circle of confusion in front of and behind the focus plane, in pixels.
    pub most_px: [f32; 2],
    /// Reciprocal of the image size, in 1/pixels.
    pub per_px: [f32; 2],
    /// Focus distance, in m.
    pub focus_m: f32,
    /// Diameter of the circle of confusion at infinity, in pixels.
    pub scale_px: f32,
    /// Width and height of a tile, in texels of the gather.
    pub tile_texels: f32,
    /// Number of the last mip level.
    pub last_level: f32,
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(DofUniforms { depth_row, most_px, per_px, focus_m, scale_px, tile_texels, last_level })]
}
