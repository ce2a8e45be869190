//! Repeated measurements of one time, and what is reported of them: least, first quartile, median.
//!
//! Times on a shared machine have a hard floor and a long tail, so the mean says little; the least is the cost without
//! disturbance, the median what to expect.

/// The latest measurements of one time, in milliseconds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Durations {
    values: Vec<f64>,
    next: usize,
}

/// What is reported of the latest 256 measurements of one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// The least, in milliseconds.
    pub min_ms: f64,
    /// A quarter of the measurements are below or equal.
    pub p25_ms: f64,
    /// Half of the measurements are below or equal.
    pub median_ms: f64,
    /// How many measurements there are.
    pub count: usize,
}

impl Durations {
    /// Measurements kept; older ones make way.
    const KEPT: usize = 256;

    /// Adds one; what is not finite or negative is dropped.
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

    /// Forgets all measurements.
    pub(crate) fn clear(&mut self) {
        self.values.clear();
        self.next = 0;
    }

    /// Least, first quartile and median by the nearest-rank method; `None` without measurements.
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
    fn old_measurements_make_way() {
        let mut samples = Durations::default();
        for i in 0..Durations::KEPT + 10 {
            samples.push(i as f64);
        }
        let summary = samples.summary();
        assert_eq!(summary.map(|s| (s.count, s.min_ms)), Some((Durations::KEPT, 10.0)));
    }
}
