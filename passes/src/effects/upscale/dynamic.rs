//! Dynamic resolution from measured frame times, with Filament's algorithm.

/// Frame-time target of dynamic resolution, and the speed and limits of its changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicResolution {
    /// Target GPU time of a frame, in ms.
    pub target_ms: f64,
    /// Share of the target kept free, from 0 to below 1.
    pub headroom: f64,
    /// Speed of adaptation, above 0: each frame corrects 1 − e^−rate of the error.
    pub rate: f64,
    /// Number of recent frame times whose median is used, so single outliers have no effect.
    pub history: usize,
    /// Minimum width and height in percent, 25 to 100.
    pub least_percent: f64,
    /// Maximum width and height in percent, 25 to 100.
    pub most_percent: f64,
}

impl Default for DynamicResolution {
    /// Returns [`DynamicResolution::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl DynamicResolution {
    /// Filament's defaults, for 60 frames per second.
    pub const DEFAULT: Self = Self {
        target_ms: 1000.0 / 60.0,
        headroom: 0.0,
        rate: 0.125,
        history: 15,
        least_percent: 50.0,
        most_percent: 100.0,
    };

    /// Returns the width and height of the next frame in percent, for [`Upscale::percent`](super::Upscale::percent)
    /// after rounding. `percent` is the value of the last frame; `times_ms` has recent GPU times, latest last. Invalid
    /// times are ignored; without any, the percentage does not change.
    #[must_use]
    pub fn next_percent(&self, percent: f64, times_ms: &[f64]) -> f64 {
        let percent = if percent.is_finite() { percent } else { self.most_percent };
        let counted = times_ms.iter().copied().filter(|ms| ms.is_finite() && *ms >= 0.0);
        let mut last: Vec<f64> = counted.rev().take(self.history.max(1)).collect();
        last.sort_by(f64::total_cmp);
        let area = match last.get(last.len() / 2) {
            None => 1.0,
            Some(median) => {
                let wanted = (self.target_ms * (1.0 - self.headroom)).max(1e-6);
                let wrong = (1.0 - (-self.rate).exp()) * (1.0 - median / wanted);
                // Factors on the area; equal errors of opposite sign cancel.
                if wrong < 0.0 { 1.0 / (1.0 - wrong) } else { 1.0 + wrong }
            }
        };
        let (least, most) = (self.least_percent.clamp(25.0, 100.0), self.most_percent.clamp(25.0, 100.0));
        (percent * area.sqrt()).clamp(least.min(most), most)
    }
}
