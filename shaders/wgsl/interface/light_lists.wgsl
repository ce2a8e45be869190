// Group 0: the lists of lights by froxel (lib/froxel.wgsl), of one view.

import package::interface::frame::frame;
import package::lib::froxel::{froxel_number, froxel_slice};
import package::shading::shadow_map::ahead_m;

/// How the view is cut. Mirrored by `layout::FroxelUniforms`.
struct FroxelUniforms {
    /// Tiles across and down, and slices.
    counts: vec3<u32>,
    /// One over the side of a tile, in 1/pixel.
    tiles_per_px: f32,
    /// See `froxel_slice`.
    slice_scale: f32,
    slice_offset: f32,
    /// How many lights have no end, or none that the view knows of: the first ones of `lights`,
    /// which are in no list.
    everywhere: u32,
}

@group(0) @binding(2) var<uniform> froxels: FroxelUniforms;
/// For each froxel the place of its list in this array, and one more, where the last list ends;
/// then the lists, numbers of `lights` in rising order.
@group(0) @binding(3) var<storage, read> light_lists: array<u32>;

/// Where the list of a place begins in `light_lists`, and where it ends.
fn light_list_at(world: vec3<f32>, pixel: vec2<f32>) -> vec2<u32> {
    let slice = froxel_slice(
        ahead_m(world), froxels.slice_scale, froxels.slice_offset, froxels.counts.z,
    );
    let froxel = froxel_number(pixel, froxels.tiles_per_px, slice, froxels.counts);
    return vec2<u32>(light_lists[froxel], light_lists[froxel + 1u]);
}
