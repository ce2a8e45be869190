//! Mirrors of the structs of `wgsl/pass/ibl.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::Vec4;

/// Number of rows of [`IblKernelUniforms`]: 64 KiB, the minimum limit of uniform buffers in WebGPU.
pub const IBL_KERNEL_ROWS: usize = 4096;

/// Settings of one draw of `wgsl/pass/ibl.wgsl`, which fills one face and mip level of a cube map.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct IblUniforms {
    /// Face of the cube map, 0…5.
    pub face: u32,
    /// Width and height of the target in texels.
    pub size_texels: u32,
    /// `fs_cube`: samples along each side of a texel. `fs_prefilter`: number of kernel rows in use.
    pub samples: u32,
    /// Dimensionless factor on the result.
    pub scale: f32,
}

/// Sample directions of a GGX lobe around the normal.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct IblKernelUniforms {
    /// xyz: unit direction around +Z, with z also the weight. w: mip level of the cube map.
    pub rows: [Vec4; IBL_KERNEL_ROWS],
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(IblUniforms { face, size_texels, samples, scale }), layout_of!(IblKernelUniforms { rows })]
}
