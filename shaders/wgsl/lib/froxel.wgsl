// Froxels: what is seen, cut into tiles of the picture and slices of distance, with a list of the
// lights that reach into each (Olsson, Billeter and Assarsson, "Clustered Deferred and Forward
// Shading", 2012).

/// Where a distance ahead of the eye lies among the slices: in the slice of its whole part. Ends of
/// slices are at equal ratios; `scale` is one over log2 of the ratio, `offset` the number of slices
/// minus log2 of the last end times `scale`. The first slice begins behind the eye and has what is
/// no number, too, told by its bits: those of what is less than zero, or NaN, are beyond
/// infinity's. The last slice has no end (hard case 57).
fn froxel_slice(ahead_m: f32, scale: f32, offset: f32, slices: u32) -> f32 {
    let is_nowhere = bitcast<u32>(ahead_m) > 0x7f800000u;
    let ahead = clamp(select(ahead_m, 0.0, is_nowhere), 1e-30, 1e30);
    return clamp(log2(ahead) * scale + offset, 0.0, f32(slices) - 1.0);
}

/// Number of the froxel of a pixel: slice by slice, row by row. What lies beyond the last tile
/// belongs to it.
fn froxel_number(pixel: vec2<f32>, tiles_per_px: f32, slice: f32, counts: vec3<u32>) -> u32 {
    let tile = min(vec2<u32>(max(pixel, vec2<f32>(0.0)) * tiles_per_px), counts.xy - 1u);
    return (min(u32(slice), counts.z - 1u) * counts.y + tile.y) * counts.x + tile.x;
}
