//! Mirror of `wgsl/interface/light_lists.wgsl`.

use bytemuck::{Pod, Zeroable};

/// How a view is cut into froxels.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FroxelUniforms {
    /// Tiles across and down, and slices.
    pub counts: [u32; 3],
    /// One over the side of a tile, in 1/pixel.
    pub tiles_per_px: f32,
    /// One over log2 of the ratio of the distances at which a slice ends and begins.
    pub slice_scale: f32,
    /// The number of slices minus log2 of the last end times `slice_scale`.
    pub slice_offset: f32,
    /// How many lights are in no list, since they are to be looked at everywhere: the first ones.
    pub everywhere: u32,
    /// Padding to 16 bytes; zero.
    pub _pad: u32,
}

#[cfg(test)]
pub(super) fn layouts() -> Vec<crate::reflect::StructLayout> {
    vec![layout_of!(FroxelUniforms { counts, tiles_per_px, slice_scale, slice_offset, everywhere, _pad })]
}
