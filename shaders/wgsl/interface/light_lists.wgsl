// Group 0: the light lists of a view's froxels (lib/froxel.wgsl).

import package::interface::frame::frame;
import package::lib::froxel::{froxel_number, froxel_slice};
import package::shading::shadow_map::ahead_m;

/// Division of the view into froxels. Mirrored by `layout::FroxelUniforms`.
struct FroxelUniforms {
    /// Number of tiles in x and y, and of depth slices.
    counts: vec3<u32>,
    /// One over the side of a tile, in 1/pixel.
    tiles_per_px: f32,
    /// See `froxel_slice`.
    slice_scale: f32,
    slice_offset: f32,
    /// Number of lights without a known range, which affect the whole view. They come first in
    /// `lights` and are in no list.
    everywhere: u32,
}

@group(0) @binding(2) var<uniform> froxels: FroxelUniforms;
/// Start of each froxel's list in this array, followed by the end of the last list; then the lists,
/// with indices of `lights` in rising order.
@group(0) @binding(3) var<storage, read> light_lists: array<u32>;

/// Returns start and end of a position's list in `light_lists`.
fn light_list_at(world: vec3<f32>, pixel: vec2<f32>) -> vec2<u32> {
    let slice = froxel_slice(
        ahead_m(world), froxels.slice_scale, froxels.slice_offset, froxels.counts.z,
    );
    let froxel = froxel_number(pixel, froxels.tiles_per_px, slice, froxels.counts);
    return vec2<u32>(light_lists[froxel], light_lists[froxel + 1u]);
}
