//! Frame rate of the live frame.

use std::collections::VecDeque;
use std::time::Instant;

/// Times of the latest frames.
#[derive(Clone, Debug, Default)]
pub(super) struct Clock(VecDeque<Instant>);

impl Clock {
    /// Records a drawn frame.
    pub fn tick(&mut self, now: Instant) {
        // A pause must not count as a slow frame.
        if self.0.back().is_some_and(|last| now.duration_since(*last).as_secs_f32() > 2.0) {
            self.0.clear();
        }
        self.0.push_back(now);
        if self.0.len() > 32 {
            self.0.pop_front();
        }
    }

    /// Returns frames per second; `None` for fewer than four frames.
    pub fn frames_per_s(&self) -> Option<f32> {
        let (first, last) = (self.0.front()?, self.0.back()?);
        let passed = last.duration_since(*first).as_secs_f32();
        (self.0.len() >= 4 && passed > 0.0).then(|| (self.0.len() - 1) as f32 / passed)
    }
}
