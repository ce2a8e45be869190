//! Statistics of times with confidence intervals, and Pareto fronts.

use serde::{Deserialize, Serialize};
use std::fmt::Write as _;

/// Time of a frame over interleaved repeats, in ms.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Times {
    /// Minimum.
    pub min: f64,
    /// First quartile.
    pub p25: f64,
    /// Median.
    pub median: f64,
    /// Lower end of the median's 95 % bootstrap interval.
    pub low: f64,
    /// Upper end of the median's 95 % bootstrap interval.
    pub high: f64,
}

/// Bootstrap samples per interval.
const DRAWS: usize = 1000;

impl Times {
    /// Returns the statistics of at least one measurement.
    pub fn of(measured: &[f64]) -> Self {
        let sorted = sorted(measured.to_vec());
        let mut state = 0x2545_f491_4f6c_dd1d_u64;
        let mut index = |count: usize| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state % count as u64) as usize
        };
        let mut draw = || {
            let sample = (0..sorted.len()).map(|_| sorted[index(sorted.len())]).collect();
            quantile(&self::sorted(sample), 0.5)
        };
        let medians = self::sorted((0..DRAWS).map(|_| draw()).collect());
        Self {
            min: sorted[0],
            p25: quantile(&sorted, 0.25),
            median: quantile(&sorted, 0.5),
            low: quantile(&medians, 0.025),
            high: quantile(&medians, 0.975),
        }
    }

    /// Returns true if the intervals do not overlap; otherwise neither is known to be faster.
    pub fn differs_from(&self, other: &Self) -> bool {
        self.low > other.high || other.low > self.high
    }
}

fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values
}

/// Returns a quantile of sorted values, by the nearest rank.
pub fn quantile(sorted: &[f64], share: f64) -> f64 {
    let at = (share * sorted.len() as f64).ceil() as usize;
    sorted[at.clamp(1, sorted.len()) - 1]
}

/// Marks the Pareto-optimal points of (cost, error).
pub fn undominated(points: &[[f64; 2]]) -> Vec<bool> {
    let beats = |a: &[f64; 2], b: &[f64; 2]| a[0] <= b[0] && a[1] <= b[1] && a != b;
    points.iter().map(|point| !points.iter().any(|other| beats(other, point))).collect()
}

/// Formats a number with three digits.
pub fn number(x: f64) -> String {
    if x == 0.0 {
        return "0".to_owned();
    }
    let digits = (2 - x.abs().log10().floor() as i32).clamp(0, 9) as usize;
    let mut text = String::new();
    if x.abs() < 1e-4 {
        let _ = write!(text, "{x:.2e}");
    } else {
        let _ = write!(text, "{x:.digits$}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_hold_the_median_and_tell_times_apart() {
        let slow: Vec<f64> = (0..31).map(|i| 10.0 + f64::from(i % 7) * 0.1).collect();
        let fast: Vec<f64> = slow.iter().map(|t| t - 1.0).collect();
        let [slow, fast] = [slow, fast].map(|times| Times::of(&times));
        assert!(slow.min <= slow.p25 && slow.low <= slow.median && slow.median <= slow.high);
        assert!(slow.differs_from(&fast) && !slow.differs_from(&slow));
        let noisy = Times::of(&(0..31).map(|i| 2.5 + 0.5 * f64::from(i * 11 % 31)).collect::<Vec<_>>());
        assert!(!slow.differs_from(&noisy), "{noisy:?}");
        assert_eq!(quantile(&[1.0, 2.0, 3.0, 4.0], 0.25), 1.0);
    }

    #[test]
    fn what_is_beaten_is_dominated_and_equals_are_not() {
        assert_eq!(
            undominated(&[[1.0, 5.0], [2.0, 3.0], [2.5, 4.0], [3.0, 3.0], [2.0, 3.0]]),
            [true, true, false, false, true]
        );
    }
}
