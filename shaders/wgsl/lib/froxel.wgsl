// Froxels divide a view into screen tiles and depth slices, each with a list of its lights (Olsson,
// Billeter and Assarsson, "Clustered Deferred and Forward Shading", 2012).

/// Returns the fractional slice index of a distance ahead of the eye. Slices end at equal ratios:
/// `scale` is one over log2 of the ratio, `offset` the number of slices minus log2 of the last end
/// times `scale`. The first slice also holds points behind the eye and NaN, both detected by their
/// bits. The last slice has no end (hard case 57).
fn froxel_slice(ahead_m: f32, scale: f32, offset: f32, slices: u32) -> f32 {
    let is_nowhere = bitcast<u32>(ahead_m) > 0x7f800000u;
    let ahead = clamp(select(ahead_m, 0.0, is_nowhere), 1e-30, 1e30);
    return clamp(log2(ahead) * scale + offset, 0.0, f32(slices) - 1.0);
}

/// Returns the froxel index of a pixel, ordered by slice, row and column. Pixels past the last tile
/// belong to it.
fn froxel_number(pixel: vec2<f32>, tiles_per_px: f32, slice: f32, counts: vec3<u32>) -> u32 {
    let tile = min(vec2<u32>(max(pixel, vec2<f32>(0.0)) * tiles_per_px), counts.xy - 1u);
    return (min(u32(slice), counts.z - 1u) * counts.y + tile.y) * counts.x + tile.x;
}
