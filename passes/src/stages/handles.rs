//! What stages take and hand on.

use super::error::StageError;
use super::slot::Slot;
use crate::view::ViewId;
use framegraph::{Extent, Graph, Target, Texture};

/// Stands for the stage in errors outside of stages.
pub(super) const CALLER: &str = "the caller";

/// The textures that stages hand on, and what is declared: which view, of which size.
#[derive(Clone, Debug)]
pub struct Handles {
    view: ViewId,
    extent: Extent,
    slots: Vec<Held>,
    /// The stage that is being declared.
    stage: &'static str,
    target: Target,
}

/// A slot's texture.
#[derive(Clone, Copy, Debug)]
struct Held {
    slot: Slot,
    texture: Texture,
    /// The stage that handed it on.
    by: &'static str,
    checked: bool,
}

impl Default for Handles {
    /// The main view in the frame's size.
    fn default() -> Self {
        Self::for_view(ViewId::MAIN, Extent::FRAME)
    }
}

impl Handles {
    /// A view with pictures of that size, and no textures yet.
    pub fn for_view(view: ViewId, extent: Extent) -> Self {
        Self { view, extent, slots: Vec::with_capacity(8), stage: CALLER, target: Target::New }
    }

    /// The same with a texture from the start; a shadow map that several views share, say.
    #[must_use]
    pub fn with(mut self, slot: Slot, texture: Texture) -> Self {
        self.set(slot, texture);
        self
    }

    /// The view that is declared.
    pub const fn view(&self) -> ViewId {
        self.view
    }

    /// The size of the view's pictures.
    pub const fn extent(&self) -> Extent {
        self.extent
    }

    /// Where a stage that makes the picture ([`Stage::picture`](super::Stage::picture)) is to put it: the frame's target for
    /// the last such stage, a new texture for those before.
    pub const fn target(&self) -> Target {
        self.target
    }

    /// What a slot holds, if anything.
    pub fn find(&self, slot: Slot) -> Option<Texture> {
        self.held(slot).map(|held| held.texture)
    }

    /// Slots of one name are one slot.
    fn held(&self, slot: Slot) -> Option<&Held> {
        self.slots.iter().find(|held| held.slot.name == slot.name)
    }

    /// What a slot holds.
    ///
    /// # Errors
    /// When no stage has handed it on.
    pub fn get(&self, slot: Slot) -> Result<Texture, StageError> {
        self.find(slot).ok_or(StageError::Missing { stage: self.stage, slot: slot.name })
    }

    /// Hands a texture on to later stages, instead of what the slot held. Every write makes a new handle; hand that on.
    pub fn set(&mut self, slot: Slot, texture: Texture) {
        let held = Held { slot, texture, by: self.stage, checked: false };
        match self.slots.iter_mut().find(|held| held.slot.name == slot.name) {
            Some(own) => *own = held,
            None => self.slots.push(held),
        }
    }

    /// The error of a stage that would average `samples` over what another stage handed on in `slot`.
    pub(crate) fn lost(&self, slot: Slot, samples: Slot) -> StageError {
        let by = self.held(slot).map_or("", |held| held.by);
        StageError::Lost { stage: self.stage, slot: slot.name, samples: samples.name, by }
    }

    /// Begins a stage: it is named in errors, and makes its picture in `target`.
    pub(super) fn begin(&mut self, stage: &'static str, target: Target) {
        self.stage = stage;
        self.target = target;
    }

    /// Refuses what was handed on since the last check and is not what its slot holds.
    pub(super) fn check(&mut self, graph: &Graph) -> Result<(), StageError> {
        for held in self.slots.iter_mut().filter(|held| !held.checked) {
            let Held { slot, texture, by: stage, .. } = *held;
            let resource = graph.resource_of(texture).ok_or(StageError::Foreign { stage, slot: slot.name })?;
            let desc = graph.resources()[resource.index()].desc.texture().copied();
            if let Some(fault) = desc.and_then(|desc| slot.fault(desc.format, desc.samples)) {
                let texture = graph.resource_name(resource).to_owned();
                return Err(StageError::Wrong { stage, slot: slot.name, texture, fault });
            }
            held.checked = true;
        }
        Ok(())
    }

    /// Refuses a picture that is elsewhere than in `target`.
    pub(super) fn check_target(&self, graph: &Graph, target: Target) -> Result<(), StageError> {
        let (Target::Into(part), Some(picture)) = (target, self.held(Slot::PICTURE)) else {
            return Ok(());
        };
        match graph.resource_of(picture.texture) {
            Some(resource) if graph.resource_of(part.texture()) != Some(resource) => {
                let texture = graph.resource_name(resource).to_owned();
                Err(StageError::OtherTarget { stage: picture.by, texture })
            }
            _ => Ok(()),
        }
    }
}
