//! Comparison of two 8-bit pictures.

/// Difference of two pictures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// Peak signal-to-noise ratio over red, green and blue in dB; infinite for equal pictures.
    pub psnr_db: f64,
    /// Share of pixels with a channel that differs by more than 2 of 255 steps, 0…1.
    pub share_off: f64,
    /// Largest difference of any channel, in 8-bit steps.
    pub largest_codes: u8,
}

/// Compares red, green and blue of two pictures of four bytes per texel. Returns `None` if their lengths differ or are
/// not multiples of four.
pub fn compare(a: &[u8], b: &[u8]) -> Option<Difference> {
    if a.len() != b.len() || a.is_empty() || !a.len().is_multiple_of(4) {
        return None;
    }
    let (mut squares, mut off, mut largest) = (0u64, 0u64, 0u8);
    for (p, q) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        let worst = (0..3).map(|c| p[c].abs_diff(q[c])).inspect(|d| squares += u64::from(*d) * u64::from(*d)).max();
        let worst = worst.unwrap_or(0);
        off += u64::from(worst > 2);
        largest = largest.max(worst);
    }
    let pixels = (a.len() / 4) as f64;
    let mean = squares as f64 / (pixels * 3.0);
    let psnr_db = if squares == 0 { f64::INFINITY } else { 10.0 * (255.0 * 255.0 / mean).log10() };
    Some(Difference { psnr_db, share_off: off as f64 / pixels, largest_codes: largest })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_pictures_are_infinitely_close_and_others_are_not() {
        let a = [10, 20, 30, 255, 1, 2, 3, 255];
        assert_eq!(compare(&a, &a), Some(Difference { psnr_db: f64::INFINITY, share_off: 0.0, largest_codes: 0 }));
        let mut b = a;
        b[4] += 3;
        let d = compare(&a, &b).expect("two pictures");
        assert_eq!((d.share_off, d.largest_codes), (0.5, 3));
        assert!((d.psnr_db - 10.0 * (255.0f64 * 255.0 * 6.0 / 9.0).log10()).abs() < 1e-9);
        let mut alpha = a;
        alpha[3] = 0;
        assert_eq!(compare(&a, &alpha).map(|d| d.largest_codes), Some(0), "alpha does not count");
        assert_eq!(compare(&a, &a[..4]), None);
    }
}
