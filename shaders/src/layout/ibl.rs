//! Mirrors of the structs of `wgsl/pass/ibl.wgsl`.

use bytemuck::{Pod, Zeroable};
use glam::Vec4;

/// Rows of [`IblKernelUniforms`]: 64 KiB, what WebGPU guarantees for uniform buffers.
pub const IBL_KERNEL_ROWS: usize = 4096;

/// Settings of one draw of `wgsl/pass/ibl.wgsl`, which fills one face and level of a cube.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct IblUniforms {
    /// Face of the cube, 0…5.
    pub face: u32,
    /// Width and height of the target in texels.
    pub size_texels: u32,
    /// `fs_cube`: samples along each side of a texel; `fs_prefilter`: rows of the kernel in use.
    pub samples: u32,
    /// Factor on the result, without unit.
    pub scale: f32,
}

/// Sample directions of a GGX lobe about the normal.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct IblKernelUniforms {
    /// Unit direction about +Z in xyz, whose z is also the weight; mip level of the cube to read in w.
    pub rows: [Vec4; IBL_KERNEL_ROWS],
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(IblUniforms { face, size_texels, samples, scale }), layout_of!(IblKernelUniforms { rows })]
}
