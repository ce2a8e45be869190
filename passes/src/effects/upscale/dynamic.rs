//! How much smaller the next frame is drawn, by the times of those before, as Filament decides it.

/// Times that a frame is to keep, and how fast and how far its size follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicResolution {
    /// The time that a frame is to take on the GPU, in ms.
    pub target_ms: f64,
    /// The share of it that is kept free, 0 to less than 1.
    pub headroom: f64,
    /// How fast the size follows, above 0: 1 − e^−rate of what is wrong is made up for in a frame.
    pub rate: f64,
    /// How many frames' times count: their median, so that a single late one is none of its business.
    pub history: usize,
    /// The least share of the sides, in percent, 25 to 100.
    pub least_percent: f64,
    /// The most.
    pub most_percent: f64,
}

impl Default for DynamicResolution {
    /// [`DynamicResolution::DEFAULT`].
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl DynamicResolution {
    /// Filament's, for 60 frames a second.
    pub const DEFAULT: Self = Self {
        target_ms: 1000.0 / 60.0,
        headroom: 0.0,
        rate: 0.125,
        history: 15,
        least_percent: 50.0,
        most_percent: 100.0,
    };

    /// The share of the sides in percent that the next frame is drawn with, where the last was drawn with `percent`, and the
    /// frames so far took `times_ms`, the last at the end. Rounded, it is [`Upscale::percent`](super::Upscale::percent). Times
    /// that are no numbers do not count, and without any the share stays.
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
                // Shares of the area that undo each other.
                if wrong < 0.0 { 1.0 / (1.0 - wrong) } else { 1.0 + wrong }
            }
        };
        let (least, most) = (self.least_percent.clamp(25.0, 100.0), self.most_percent.clamp(25.0, 100.0));
        (percent * area.sqrt()).clamp(least.min(most), most)
    }
}
