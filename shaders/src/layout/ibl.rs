//! Mirrors of the structs of `wgsl/pass/ibl.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::Vec4;

/// Rows of [`IblKernelUniforms`]: 64 KiB, what WebGPU guarantees for uniform buffers.
pub const IBL_KERNEL_ROWS: usize = 4096;

/// What one draw of the image-based light's passes fills.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct IblUniforms {
    /// Face of the cube, 0…5.
    pub face: u32,
    /// Width and height of the target in texels.
    pub size_texels: u32,
    /// Samples along a side of a texel, or rows of the kernel in use.
    pub samples: u32,
    /// Factor on the result.
    pub scale: f32,
}

/// The samples of a lobe.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct IblKernelUniforms {
    /// Direction about +Z in xyz, level of the cube to read in w.
    pub rows: [Vec4; IBL_KERNEL_ROWS],
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(IblUniforms { face, size_texels, samples, scale }), layout_of!(IblKernelUniforms { rows })]
}
