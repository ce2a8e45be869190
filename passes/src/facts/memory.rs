//! What the frames before decided: effects do not come and go with every frame at a threshold.

use super::effect::{Effect, EffectSet};

/// An effect goes once so many frames in a row did without.
const PATIENCE: u8 = 8;
/// By so much of a threshold a measure must be under it before an effect goes; it comes back at the threshold itself.
const MARGIN: f64 = 0.1;

/// Kept by the caller from frame to frame, one for each view or group of views that is decided together. A new one decides
/// its first frame at once; what is needed comes back at once in any frame, so that no picture lacks it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FactMemory {
    /// Frames in a row that did without each effect, at most [`PATIENCE`].
    calm: [u8; Effect::ALL.len()],
    /// A frame was decided.
    begun: bool,
}

impl FactMemory {
    /// Whether a measure is under its threshold, by a margin where the frame before had the effect.
    pub(super) fn within(&self, effect: Effect, measure: f64, limit: f64) -> bool {
        let had = self.begun && self.calm[effect as usize] < PATIENCE;
        measure <= if had { limit * (1.0 - MARGIN) } else { limit }
    }

    /// Of the effects that this frame could do without, those that go.
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

    /// Frames that an effect waits for until it goes.
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
