// A pyramid of depth: each level keeps one of four texels of the level above, in a rotated grid, so
// that a level is a fair sample of what is there and no average of it (McGuire, Mara and Luebke,
// "Scalable Ambient Obscurance", 2012).

/// The texel of the next finer level that a texel keeps.
fn finer_texel(texel: vec2<i32>) -> vec2<i32> {
    return 2 * texel + vec2<i32>(texel.y & 1, texel.x & 1);
}

/// The texel of level 0 that a texel of `level` keeps: where its depth belongs. Taking the depth
/// for that of another place tilts surfaces, and shadows flat ones.
fn finest_texel(texel: vec2<i32>, level: i32) -> vec2<i32> {
    var fine = texel;
    for (var i = 0; i < level; i++) {
        fine = finer_texel(fine);
    }
    return fine;
}

/// The level to read so many pixels away from the middle: an eighth of the distance is between its
/// texels.
fn pyramid_level(distance_px: f32, last_level: i32) -> i32 {
    return clamp(i32(floor(log2(max(distance_px, 1.0)))) - 3, 0, last_level);
}
