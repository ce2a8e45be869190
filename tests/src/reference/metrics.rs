//! Metrics of a picture compared with its reference.

use super::picture::Picture;
use truth::flip::{PIXELS_PER_DEGREE, flip};

/// Metrics of a comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Metrics {
    /// Peak signal-to-noise ratio of the clamped, sRGB-encoded pictures in dB, over all channels; infinite for equal
    /// ones.
    pub psnr_db: f64,
    /// Mean FLIP error at 67 pixels per degree, 0…1.
    pub flip: f64,
    /// Share of pixels with a channel that differs by more than 2 8-bit steps, 0…1.
    pub off_2: f64,
    /// Share of pixels with a channel that differs by more than 8 8-bit steps, 0…1.
    pub off_8: f64,
    /// |a − b| / (|b| + 0.01) of linear light, b being the reference: median, 95th and 99th percentile of all channels.
    pub relative: [f64; 3],
}

impl Metrics {
    /// Compares `ours` with `reference`; `None` if their sizes differ.
    pub fn of(ours: &Picture, reference: &Picture) -> Option<Self> {
        let others = Self::without_flip(ours, reference)?;
        let differences = flip(&ours.encoded, &reference.encoded, ours.size_px, PIXELS_PER_DEGREE);
        let flip = differences.iter().map(|d| f64::from(*d)).sum::<f64>() / differences.len() as f64;
        Some(Self { flip, ..others })
    }

    /// Compares with all metrics but FLIP, which is NaN.
    pub fn without_flip(ours: &Picture, reference: &Picture) -> Option<Self> {
        if ours.size_px != reference.size_px || ours.encoded.is_empty() {
            return None;
        }
        let (mut squares, mut off_2, mut off_8) = (0.0, 0_u64, 0_u64);
        for (a, b) in ours.encoded.iter().zip(&reference.encoded) {
            let apart: [f64; 3] = std::array::from_fn(|c| f64::from(a[c]) - f64::from(b[c]));
            squares += apart.iter().map(|d| d * d).sum::<f64>();
            let worst = apart.iter().fold(0.0_f64, |worst, d| worst.max(d.abs())) * 255.0;
            // The tolerance keeps differences of exactly 2 steps from counting after rounding.
            off_2 += u64::from(worst > 2.0 + 1e-4);
            off_8 += u64::from(worst > 8.0 + 1e-4);
        }
        let count = ours.encoded.len() as f64;
        let psnr_db = if squares == 0.0 { f64::INFINITY } else { 10.0 * (3.0 * count / squares).log10() };
        let (off_2, off_8) = (off_2 as f64 / count, off_8 as f64 / count);
        Some(Self { psnr_db, flip: f64::NAN, off_2, off_8, relative: relative(ours, reference) })
    }
}

fn relative(ours: &Picture, reference: &Picture) -> [f64; 3] {
    let pairs = ours.linear.as_flattened().iter().zip(reference.linear.as_flattened());
    let mut errors: Vec<f64> = pairs.map(|(a, b)| relative_error((*a).into(), (*b).into())).collect();
    // Values that are not finite count as infinitely wrong.
    errors.iter_mut().filter(|e| !e.is_finite()).for_each(|e| *e = f64::INFINITY);
    [0.5, 0.95, 0.99].map(|share| {
        let at = ((errors.len() - 1) as f64 * share).round() as usize;
        *errors.select_nth_unstable_by(at, f64::total_cmp).1
    })
}

/// |a − b| / (|b| + 0.01).
pub fn relative_error(ours: f64, reference: f64) -> f64 {
    (ours - reference).abs() / (reference.abs() + 0.01)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_differences_have_known_sizes() {
        let grey = |code: u8| Picture::from_codes([4, 2], &[code, code, code, 255].repeat(8));
        let same = Metrics::of(&grey(100), &grey(100)).expect("one size");
        assert_eq!((same.psnr_db, same.flip, same.off_2, same.relative), (f64::INFINITY, 0.0, 0.0, [0.0; 3]));
        let near = Metrics::of(&grey(102), &grey(100)).expect("one size");
        assert!((near.psnr_db - 20.0 * (255.0_f64 / 2.0).log10()).abs() < 1e-3 && near.off_2 == 0.0, "{near:?}");
        let far = Metrics::of(&grey(110), &grey(100)).expect("one size");
        assert_eq!((far.off_2, far.off_8), (1.0, 1.0));
        let light = |c: f32| Picture::from_linear([1, 1], vec![[c; 3]]);
        let relative = Metrics::of(&light(2.2), &light(1.99)).expect("one size").relative;
        assert!((relative[0] - 0.105).abs() < 1e-6, "{relative:?}");
        assert_eq!(Metrics::of(&light(f32::NAN), &light(1.0)).map(|m| m.relative[0]), Some(f64::INFINITY));
        assert_eq!(Metrics::of(&light(1.0), &grey(1)), None);
    }
}
