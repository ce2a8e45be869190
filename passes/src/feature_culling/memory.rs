//! Decisions of earlier frames. They prevent effects from flickering at a threshold.

use super::effect::{Effect, EffectSet};

/// Number of consecutive frames without need after which an effect is dropped.
const PATIENCE: u8 = 8;
/// Margin below a threshold, as a fraction, that a measure needs before its effect is dropped. The effect returns at
/// the threshold.
const MARGIN: f64 = 0.1;

/// Hysteresis of decisions, kept by the caller for each view, or group of views decided together. A new memory
/// decides its first frame at once. A needed effect returns at once in any frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FactMemory {
    /// Consecutive frames that did not need each effect, at most [`PATIENCE`].
    calm: [u8; Effect::ALL.len()],
    /// True after the first frame.
    begun: bool,
}

impl FactMemory {
    /// Returns whether a measure is below its threshold, with a margin if the previous frame had the effect.
    pub(super) fn within(&self, effect: Effect, measure: f64, limit: f64) -> bool {
        let had = self.begun && self.calm[effect as usize] < PATIENCE;
        measure <= if had { limit * (1.0 - MARGIN) } else { limit }
    }

    /// Returns the effects to drop among those that this frame does not need.
    pub(super) fn settle(&mut self, unneeded: EffectSet) -> EffectSet {
        for (effect, calm) in Effect::ALL.into_iter().zip(&mut self.calm) {
            *calm = match (unneeded.contains(effect), self.begun) {
                (false, _) => 0,
                (true, false) => PATIENCE,
                (true, true) => (*calm + 1).min(PATIENCE),
            };
        }
        self.begun = true;
        Effect::ALL.into_iter().filter(|effect| self.calm[*effect as usize] == PATIENCE).collect()
    }

    /// Number of frames after which an unneeded effect is dropped.
    pub(super) fn waits(&self, effect: Effect) -> u8 {
        PATIENCE - self.calm[effect as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FXAA: EffectSet = EffectSet::NONE.with(Effect::Fxaa);

    #[test]
    fn effects_come_at_once_and_go_after_some_frames() {
        let mut memory = FactMemory::default();
        assert_eq!(memory.settle(FXAA), FXAA, "the first frame decides at once");
        assert_eq!(memory.settle(EffectSet::NONE), EffectSet::NONE, "what is needed comes at once");
        for frame in 1..PATIENCE {
            assert_eq!(memory.settle(FXAA), EffectSet::NONE, "frame {frame}");
        }
        assert_eq!(memory.settle(FXAA), FXAA);
        assert_eq!(memory.settle(FXAA), FXAA, "and stays away");
    }

    #[test]
    fn a_threshold_has_a_margin_on_the_side_that_has_the_effect() {
        let mut memory = FactMemory::default();
        let at = |memory: &FactMemory, measure| memory.within(Effect::Fxaa, measure, 2.0);
        assert!(at(&memory, 2.0) && !at(&memory, 2.01));
        memory.settle(EffectSet::NONE);
        assert!(at(&memory, 1.79) && !at(&memory, 1.81), "it is there: it stays until well under the threshold");
        for _ in 0..PATIENCE {
            memory.settle(FXAA);
        }
        assert!(at(&memory, 2.0) && !at(&memory, 2.01), "it is gone: it comes back at the threshold");
    }
}
