//! Frame rate control: chooses the set for the next frame of a running application.

/// Consecutive frames above the target after which a faster set is chosen. A single frame may be an outlier.
const OVER_FRAMES: u32 = 3;
/// Consecutive frames for which a finer set must be predicted to fit before it is chosen.
const UNDER_FRAMES: u32 = 60;
/// Fraction of the target that a finer set must fit.
const ROOM: f64 = 0.9;
/// Weight of one measured frame in the estimates.
const OWN: f64 = 0.25;
const ALL: f64 = 0.1;

/// Chooses among sets by measured frame times, with hysteresis. Three frames above the target choose a faster set. A
/// finer set is chosen after 60 frames in which it was predicted to leave a tenth of the target free. The caller
/// measures the frame times; the controller has no clock.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameRate {
    target_ms: f64,
    /// Estimated frame time of each set in milliseconds.
    believed_ms: Vec<f64>,
    at: usize,
    over: u32,
    under: u32,
}

impl FrameRate {
    /// Creates a controller for sets from the fastest to the finest, each with its predicted frame time in
    /// milliseconds, such as those of [`Offers::front`](super::Offers::front). Starts with the finest set that fits
    /// `target_ms`, else with the first. Returns `None` without sets, or if a time is not a positive number.
    pub fn new(target_ms: f64, predicted_ms: &[f64]) -> Option<Self> {
        let sound = |ms: &f64| *ms > 0.0 && ms.is_finite();
        if predicted_ms.is_empty() || !predicted_ms.iter().chain([&target_ms]).all(sound) {
            return None;
        }
        let mut rate = Self { target_ms, believed_ms: predicted_ms.to_vec(), at: 0, over: 0, under: 0 };
        rate.at = rate.finest_within(target_ms);
        Some(rate)
    }

    /// Returns the set for the next frame.
    pub fn set(&self) -> usize {
        self.at
    }

    /// Takes the measured time in milliseconds of a frame drawn with [`FrameRate::set`], and returns the set for the
    /// next frame. Ignores times that are not positive numbers.
    pub fn frame(&mut self, took_ms: f64) -> usize {
        if !(took_ms > 0.0 && took_ms.is_finite()) {
            return self.at;
        }
        // Limits outliers to twice the estimate.
        let ratio = (took_ms / self.believed_ms[self.at]).clamp(0.5, 2.0);
        let [own, all] = [OWN, ALL].map(|share| 1.0 + share * (ratio - 1.0));
        for (index, believed) in self.believed_ms.iter_mut().enumerate() {
            *believed *= if index == self.at { own } else { all };
        }
        self.over = if took_ms > self.target_ms { self.over + 1 } else { 0 };
        let finer = self.finest_within(ROOM * self.target_ms);
        self.under = if finer > self.at { self.under + 1 } else { 0 };
        if self.over >= OVER_FRAMES && self.at > 0 {
            self.take(self.finest_within(ROOM * self.target_ms).min(self.at - 1));
        } else if self.under >= UNDER_FRAMES {
            self.take(finer);
        }
        self.at
    }

    fn take(&mut self, set: usize) {
        (self.at, self.over, self.under) = (set, 0, 0);
    }

    fn finest_within(&self, ms: f64) -> usize {
        self.believed_ms.iter().rposition(|believed| *believed <= ms).unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SETS_MS: [f64; 4] = [4.0, 7.0, 11.0, 20.0];
    const TARGET_MS: f64 = 16.0;

    /// Simulates frames of a device slower than predicted by a factor; returns the sets used.
    fn run(rate: &mut FrameRate, frames: u32, slow: impl Fn(u32) -> f64) -> Vec<usize> {
        let draw = |frame: u32| {
            let set = rate.set();
            rate.frame(SETS_MS[set] * slow(frame));
            set
        };
        (0..frames).map(draw).collect()
    }

    fn switches(sets: &[usize]) -> usize {
        sets.windows(2).filter(|pair| pair[0] != pair[1]).count()
    }

    #[test]
    fn a_slow_device_gets_a_faster_set_within_frames_and_keeps_it() {
        let mut rate = FrameRate::new(TARGET_MS, &SETS_MS).expect("sound times");
        assert_eq!(rate.set(), 2, "the finest that fits");
        let sets = run(&mut rate, 300, |_| 1.9);
        assert!(sets[4..].iter().all(|set| *set == 1), "{sets:?}");
    }

    #[test]
    fn one_slow_frame_changes_nothing() {
        let mut rate = FrameRate::new(TARGET_MS, &SETS_MS).expect("sound times");
        let sets = run(&mut rate, 500, |frame| if frame % 50 == 7 { 4.0 } else { 1.0 });
        assert!(switches(&sets) == 0, "{sets:?}");
    }

    #[test]
    fn a_finer_set_comes_after_a_second_and_no_oscillation_follows() {
        let mut rate = FrameRate::new(TARGET_MS, &SETS_MS).expect("sound times");
        let slow = run(&mut rate, 200, |_| 3.0);
        assert_eq!(slow.last(), Some(&0));
        let sets = run(&mut rate, 600, |_| 0.6);
        assert_eq!(sets.last(), Some(&3), "everything fits: {sets:?}");
        assert!(sets[..60].iter().all(|set| *set == 0), "not before a second has passed: {sets:?}");
        assert!(switches(&sets) <= 3, "{sets:?}");
        // Just above the target, it steps down once and stays while nothing changes.
        let sets = run(&mut rate, 2000, |_| 0.85);
        assert!(switches(&sets) <= 1 && sets.last() == Some(&2), "{sets:?}");
    }

    #[test]
    fn what_is_no_time_is_refused() {
        assert_eq!(FrameRate::new(TARGET_MS, &[]), None);
        assert_eq!(FrameRate::new(f64::NAN, &SETS_MS), None);
        let mut rate = FrameRate::new(TARGET_MS, &SETS_MS).expect("sound times");
        let before = rate.clone();
        for took in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            rate.frame(took);
        }
        assert_eq!(rate, before);
    }
}
