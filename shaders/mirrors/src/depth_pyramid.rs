//! Mirror of `wgsl/lib/depth_pyramid.wgsl`.

/// Returns the texel of the next finer level that a texel is copied from.
pub fn finer_texel([x, y]: [i32; 2]) -> [i32; 2] {
    [2 * x + y.rem_euclid(2), 2 * y + x.rem_euclid(2)]
}

/// Returns the texel of level 0 that a texel of `level` is copied from.
pub fn finest_texel(texel: [i32; 2], level: i32) -> [i32; 2] {
    (0..level).fold(texel, |texel, _| finer_texel(texel))
}

/// Returns the level to read at a distance from the center, in pixels.
pub fn pyramid_level(distance_px: f64, last_level: i32) -> i32 {
    (distance_px.max(1.0).log2().floor() as i32 - 3).clamp(0, last_level)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verifies that each texel keeps one of its four source texels, in a rotated grid that differs between neighbors.
    #[test]
    fn each_texel_keeps_one_of_its_own() {
        let mut corners = [[false; 2]; 2];
        for y in 0..8 {
            for x in 0..8 {
                let [fine_x, fine_y] = finer_texel([x, y]);
                let (dx, dy) = (fine_x - 2 * x, fine_y - 2 * y);
                corners[dx as usize][dy as usize] = true;
                let [deep_x, deep_y] = finest_texel([x, y], 4);
                assert_eq!([deep_x >> 4, deep_y >> 4], [x, y]);
            }
        }
        assert_eq!(corners, [[true; 2]; 2]);
        assert_eq!(finest_texel([3, 5], 0), [3, 5]);
    }

    #[test]
    fn levels_are_an_eighth_of_the_distance() {
        assert_eq!([1.0, 15.9, 16.0, 33.0, 1e6].map(|d| pyramid_level(d, 4)), [0, 0, 1, 2, 4]);
    }
}
