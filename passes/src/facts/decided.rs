//! What was decided about a frame.

use super::effect::{Effect, EffectSet};
use super::fact::{Decision, Fact, Proof};
use crate::measure::Measure;
use framegraph_scene::environment::ShBands;

/// What was decided about a frame.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    /// A row for each effect that the settings ask for, in the order of [`Effect::ALL`].
    pub rows: Vec<Fact>,
    /// What the frame leaves out by its structure, whatever is forced: lights that reach nothing, variants of shaders that
    /// nothing in view needs. The class of the proof, and a sentence.
    pub always: Vec<(Proof, String)>,
    /// What is to be measured of the frame, since the frames after it are decided by that.
    pub measure: Measure,
    /// Of what is not left out altogether, how much is made.
    pub(super) amounts: Amounts,
}

/// How much is made of an effect that is dropped in part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Amounts {
    pub(super) lamp_maps: u8,
    pub(super) lamp_layers: u8,
    pub(super) glass_layers: u8,
    pub(super) bands: ShBands,
}

impl Facts {
    /// What is dropped.
    pub fn dropped(&self) -> EffectSet {
        self.rows.iter().filter(|row| row.decision == Decision::Dropped).map(|row| row.effect).collect()
    }

    /// The row of an effect; none where the settings do not ask for it.
    pub fn of(&self, effect: Effect) -> Option<&Fact> {
        self.rows.iter().find(|row| row.effect == effect)
    }
}
