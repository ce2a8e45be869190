// Depth pyramid: each level keeps one of four texels of the previous level, in a rotated grid. A
// level is therefore a fair sample of the surfaces, not an average (McGuire, Mara and Luebke,
// "Scalable Ambient Obscurance", 2012).

/// Returns the texel of the next finer level that a texel is copied from.
fn finer_texel(texel: vec2<i32>) -> vec2<i32> {
    return 2 * texel + vec2<i32>(texel.y & 1, texel.x & 1);
}

/// Returns the texel of level 0 that a texel of `level` is copied from. Using its depth at another
/// position tilts surfaces and shadows flat ones. The lowest bits of the texel alternate below it,
/// as `finer_texel` exchanges them at each level.
fn finest_texel(texel: vec2<i32>, level: i32) -> vec2<i32> {
    let rest = u32(31 - level);
    let first = i32((0xaaaaaaaau >> rest) >> 1u);
    let second = i32((0x55555555u >> rest) >> 1u);
    let odd = texel & vec2<i32>(1);
    return (texel << vec2<u32>(u32(level))) + first * odd.yx + second * odd;
}

/// Returns the level to read at a distance from the center, in pixels: its texel size is an eighth
/// of the distance.
fn pyramid_level(distance_px: f32, last_level: i32) -> i32 {
    return clamp(i32(floor(log2(max(distance_px, 1.0)))) - 3, 0, last_level);
}
