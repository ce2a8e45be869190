//! Mirror of `wgsl/lib/froxel.wgsl`.

use glam::DVec2;

/// Returns the fractional slice index of a distance ahead of the eye; its integer part is the slice.
pub fn froxel_slice(ahead_m: f64, scale: f64, offset: f64, slices: u32) -> f64 {
    // The comparison is false for NaN.
    let ahead = if ahead_m > 0.0 { ahead_m.clamp(1e-30, 1e30) } else { 1e-30 };
    (ahead.log2() * scale + offset).clamp(0.0, f64::from(slices) - 1.0)
}

/// Returns the froxel index of a pixel, ordered by slice, row and column.
pub fn froxel_number(pixel: DVec2, tiles_per_px: f64, slice: f64, counts: [u32; 3]) -> u32 {
    let tile = |at: f64, count: u32| ((at.max(0.0) * tiles_per_px) as u32).min(count - 1);
    ((slice as u32).min(counts[2] - 1) * counts[1] + tile(pixel.y, counts[1])) * counts[0] + tile(pixel.x, counts[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Verifies that slices between 5 m and 100 m end at equal ratios.
    #[test]
    fn slices_end_where_they_should() {
        let slices = 16;
        let scale = 15.0 / 20_f64.log2();
        let offset = 16.0 - 100_f64.log2() * scale;
        for end in 1..16 {
            let at_m = 100.0 * 20_f64.powf(f64::from(end - 16) / 15.0);
            let [before, after] = [0.999, 1.001].map(|k| froxel_slice(k * at_m, scale, offset, slices) as u32);
            assert_eq!([before, after], [end as u32 - 1, end as u32]);
        }
        for (outside, slice) in [(0.0, 0.0), (-3.0, 0.0), (f64::NAN, 0.0), (1e9, 15.0), (f64::INFINITY, 15.0)] {
            assert_eq!(froxel_slice(outside, scale, offset, slices), slice, "{outside}");
        }
    }

    #[test]
    fn froxels_are_numbered_without_gaps() {
        let counts = [3, 2, 4];
        let middles = (0..24).map(|i: u32| (DVec2::new(f64::from(i % 3), f64::from(i / 3 % 2)) + 0.5) * 8.0);
        let numbers: Vec<u32> =
            middles.enumerate().map(|(i, pixel)| froxel_number(pixel, 0.125, (i / 6) as f64 + 0.3, counts)).collect();
        assert_eq!(numbers, (0..24).collect::<Vec<_>>());
        assert_eq!(froxel_number(DVec2::new(1e4, 1e4), 0.125, 3.0, counts), 23, "beyond the last tile");
    }
}
