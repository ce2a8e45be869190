//! Mirror of `wgsl/lib/depth_normal.wgsl`.

/// Returns true if the surface at `here` continues toward larger coordinates rather than smaller ones.
pub fn continues_ahead(back: [f64; 2], here: f64, ahead: [f64; 2]) -> bool {
    let behind = (2.0 * back[1] - back[0] - here).abs().min((back[1] - here).abs());
    let before = (2.0 * ahead[0] - ahead[1] - here).abs().min((ahead[0] - here).abs());
    before < behind
}

/// Returns [`continues_ahead`] for a texel of a texture whose last texel is `last`, with neighbors at steps of `axis`.
pub fn continues_ahead_inside(
    texel: [i32; 2],
    axis: [i32; 2],
    last: [i32; 2],
    back: [f64; 2],
    here: f64,
    ahead: [f64; 2],
) -> bool {
    let at_start = (0..2).any(|c| texel[c] - axis[c] < 0);
    let at_end = (0..2).any(|c| texel[c] + axis[c] > last[c]);
    at_start || (!at_end && continues_ahead(back, here, ahead))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The edge texel, repeated beyond the border, looks like a surface at right angles to the view.
    #[test]
    fn the_surface_is_inside_the_texture() {
        let side = |x, back, ahead| continues_ahead_inside([x, 3], [1, 0], [9, 9], back, 2.0, ahead);
        assert!(!continues_ahead([2.0, 2.0], 2.0, [3.0, 4.0]) && side(0, [2.0, 2.0], [3.0, 4.0]));
        assert!(!side(9, [0.0, 1.5], [2.0, 2.0]));
        assert!(side(8, [9.0, 9.0], [3.0, 4.0]) && !side(1, [1.0, 1.0], [9.0, 9.0]));
    }

    #[test]
    fn the_side_of_the_same_surface_is_taken() {
        // A slope that ends at a step ahead, and one that begins after a step.
        assert!(!continues_ahead([1.0, 2.0], 3.0, [30.0, 31.0]));
        assert!(continues_ahead([30.0, 31.0], 3.0, [4.0, 5.0]));
        // A strip of two texels: neither side has a line of its own.
        assert!(continues_ahead([1.0, 1.0], 0.5, [0.5, 1.0]));
        assert!(!continues_ahead([1.0, 0.5], 0.5, [1.0, 1.0]));
        // A crease: the slope that leads to this texel wins over the slope that only meets it.
        assert!(!continues_ahead([1.0, 2.0], 3.0, [2.8, 2.5]));
    }
}
