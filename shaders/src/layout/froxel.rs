//! Mirror of `wgsl/interface/light_lists.wgsl`.

use bytemuck::{Pod, Zeroable};

/// Division of a view into froxels.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FroxelUniforms {
    /// Number of tiles in x and y, and of depth slices.
    pub counts: [u32; 3],
    /// One over the side of a tile, in 1/pixel.
    pub tiles_per_px: f32,
    /// Reciprocal of log2 of the ratio between the end and the start of a slice.
    pub slice_scale: f32,
    /// Number of slices minus log2 of the end of the last slice times `slice_scale`.
    pub slice_offset: f32,
    /// Number of lights that affect the whole view and are in no list. They come first.
    pub everywhere: u32,
    /// Padding to 16 bytes; zero.
    pub _pad: u32,
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(FroxelUniforms { counts, tiles_per_px, slice_scale, slice_offset, everywhere, _pad })]
}
