// The decisions of FXAA, apart from the texture reads.
//
// Lottes, "FXAA", NVIDIA 2009; version 3.11, console variant, with the span of the G3D engine
// (McGuire), which grows with contrast instead of with the shallowness of the edge. Lumas are
// Rec.709 sums of sRGB encoded values at the four corners of the pixel, half a texel out.

/// Returns true if the contrast is high enough to filter. The range of lumas must exceed a share of
/// the brightest, and at least `threshold_min`. Flat areas stop here, before a zero direction is
/// normalized (hard case 50).
fn fxaa_is_edge(luma_min: f32, luma_max: f32, threshold: f32, threshold_min: f32) -> bool {
    return luma_max - luma_min >= max(threshold_min, luma_max * threshold);
}

/// Returns the unit direction along the edge in texels, y downward. It is zero if opposite corners
/// balance: a one-pixel line has no direction and stays unchanged.
fn fxaa_direction(nw: f32, ne: f32, sw: f32, se: f32) -> vec2<f32> {
    let rising = sw - ne;
    let falling = se - nw;
    let d = vec2<f32>(rising + falling, rising - falling);
    let length2 = dot(d, d);
    if length2 < 1e-12 {
        return vec2<f32>(0.0);
    }
    return d * inverseSqrt(length2);
}

/// Returns the distance of the second tap pair, in texels, at most 6 and larger for more contrast.
/// `direction` is a unit vector, `range` = luma_max - luma_min, `sharpness` = 8 by default.
fn fxaa_span_texels(direction: vec2<f32>, range: f32, sharpness: f32) -> f32 {
    let largest = max(abs(direction.x), abs(direction.y));
    return 2.0 * min(range / max(largest * sharpness * 0.015, 1e-6), 3.0);
}
