//! Statistics of repeated time measurements: minimum, first quartile and median.
//!
//! Times on a shared machine have a hard minimum and a long tail, so the mean is not useful. The minimum is the cost
//! without disturbance, the median the typical cost.

/// The most recent measurements of one time, in milliseconds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Durations {
    values: Vec<f64>,
    next: usize,
}

/// Statistics of the last 256 measurements of one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Minimum, in milliseconds.
    pub min_ms: f64,
    /// First quartile, in milliseconds.
    pub p25_ms: f64,
    /// Median, in milliseconds.
    pub median_ms: f64,
    /// Number of measurements.
    pub count: usize,
}

impl Durations {
    /// Maximum number of measurements; older ones are overwritten.
    const KEPT: usize = 256;

    /// Adds a measurement. Negative and non-finite values are ignored.
    pub(crate) fn push(&mut self, ms: f64) {
        if !ms.is_finite() || ms < 0.0 {
            return;
        }
        if self.values.len() < Self::KEPT {
            self.values.push(ms);
        } else {
            self.values[self.next] = ms;
            self.next = (self.next + 1) % Self::KEPT;
        }
    }

    /// Returns the last measurement.
    #[cfg(feature = "remote")]
    pub(crate) fn last(&self) -> Option<f64> {
        let index = if self.next > 0 { self.next - 1 } else { self.values.len().checked_sub(1)? };
        self.values.get(index).copied()
    }

    /// Removes all measurements.
    pub(crate) fn clear(&mut self) {
        self.values.clear();
        self.next = 0;
    }

    /// Returns minimum, first quartile and median by the nearest-rank method; `None` without measurements.
    pub(crate) fn summary(&self) -> Option<Summary> {
        let mut sorted = self.values.clone();
        sorted.sort_by(f64::total_cmp);
        let rank = |share: f64| sorted[((share * sorted.len() as f64).ceil() as usize).clamp(1, sorted.len()) - 1];
        (!sorted.is_empty()).then(|| Summary {
            min_ms: rank(0.0),
            p25_ms: rank(0.25),
            median_ms: rank(0.5),
            count: sorted.len(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_by_count_and_bad_values_are_dropped() {
        let mut samples = Durations::default();
        assert_eq!(samples.summary(), None);
        for ms in [4.0, f64::NAN, 1.0, -1.0, 3.0, f64::INFINITY, 2.0] {
            samples.push(ms);
        }
        let summary = Summary { min_ms: 1.0, p25_ms: 1.0, median_ms: 2.0, count: 4 };
        assert_eq!(samples.summary(), Some(summary));
    }

    #[test]
    fn old_measurements_are_overwritten() {
        let mut samples = Durations::default();
        for i in 0..Durations::KEPT + 10 {
            samples.push(i as f64);
        }
        #[cfg(feature = "remote")]
        assert_eq!(samples.last(), Some((Durations::KEPT + 9) as f64));
        let summary = samples.summary();
        assert_eq!(summary.map(|s| (s.count, s.min_ms)), Some((Durations::KEPT, 10.0)));
    }
}
