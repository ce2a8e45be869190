//! All decisions about a frame.

use super::effect::{Effect, EffectSet};
use super::fact::{Decision, Fact, Proof};
use crate::effects::exposure::Measure;
use framegraph_scene::environment::ShBands;

/// All decisions about a frame.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    /// A row for each requested effect, in the order of [`Effect::ALL`].
    pub rows: Vec<Fact>,
    /// Proof and description of everything that the frame leaves out structurally, even if all effects are forced:
    /// lights that reach nothing, shader variants that nothing visible needs.
    pub always: Vec<(Proof, String)>,
    /// Measurements that later decisions need from this frame.
    pub measure: Measure,
    /// Amounts of effects that are reduced instead of dropped.
    pub(super) amounts: Amounts,
}

/// Amount of each effect that is dropped in part.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Amounts {
    pub(super) lamp_maps: u8,
    pub(super) lamp_layers: u8,
    pub(super) glass_layers: u8,
    pub(super) bands: ShBands,
}

impl Facts {
    /// Returns the dropped effects.
    pub fn dropped(&self) -> EffectSet {
        self.rows.iter().filter(|row| row.decision == Decision::Dropped).map(|row| row.effect).collect()
    }

    /// Returns the row of an effect; `None` if the settings do not request it.
    pub fn of(&self, effect: Effect) -> Option<&Fact> {
        self.rows.iter().find(|row| row.effect == effect)
    }
}
