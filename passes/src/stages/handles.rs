//! Textures that stages exchange.

use super::error::StageError;
use super::slot::Slot;
use crate::gpu_scene::shadow_views::ShadowMaps;
use crate::gpu_scene::view::ViewId;
use framegraph::{Extent, Graph, Target, Texture};
use std::panic::Location;

/// Name of the caller in errors outside of stages.
pub(super) const CALLER: &str = "the caller";

/// Textures that stages exchange, with the view and its size.
#[derive(Clone, Debug)]
pub struct Handles {
    view: ViewId,
    extent: Extent,
    /// Number of layers of the view's pictures; 2 for both eyes of a stereo view.
    layers: u16,
    slots: Vec<Held>,
    /// Stage that is being declared.
    stage: &'static str,
    target: Target,
    /// View that the shadow maps are drawn for; `None` if not known.
    shadow_view: Option<ViewId>,
}

/// Texture of a slot.
#[derive(Clone, Copy, Debug)]
struct Held {
    slot: Slot,
    texture: Texture,
    /// Stage that set the texture.
    by: &'static str,
    /// Code that set the texture.
    at: &'static Location<'static>,
    checked: bool,
}

impl Default for Handles {
    /// Returns empty handles for the main view at the frame's size.
    fn default() -> Self {
        Self::for_view(ViewId::MAIN, Extent::FRAME)
    }
}

impl Handles {
    /// Returns empty handles for a view with pictures of this size.
    pub fn for_view(view: ViewId, extent: Extent) -> Self {
        Self {
            view,
            extent,
            layers: 1,
            slots: Vec::with_capacity(8),
            stage: CALLER,
            target: Target::New,
            shadow_view: None,
        }
    }

    /// Returns handles for both eyes of a stereo view ([`CameraView::stereo`](crate::CameraView::stereo)), which are the
    /// two layers of its pictures.
    #[must_use]
    pub fn stereo(self) -> Self {
        Self { layers: 2, ..self }
    }

    /// Returns the handles with a texture set. For shadow maps use [`Handles::with_shadow_maps`].
    #[must_use]
    #[track_caller]
    pub fn with(mut self, slot: Slot, texture: Texture) -> Self {
        self.set(slot, texture);
        self
    }

    /// Returns the handles with shadow maps in `slot`, so that the frame draws none for this view.
    #[must_use]
    #[track_caller]
    pub fn with_shadow_maps(mut self, slot: Slot, maps: ShadowMaps) -> Self {
        self.set_shadow_maps(slot, maps);
        self
    }

    /// Returns the handles with the shadow maps of another view. Both views must be made with
    /// [`CameraView::together`](crate::CameraView::together); otherwise recording fails.
    #[must_use]
    #[track_caller]
    pub fn sharing_shadows(mut self, other: &Self) -> Self {
        let held = [Slot::SHADOW_MAP, Slot::SHADOW_MOMENTS].into_iter().find(|slot| other.find(*slot).is_some());
        if let Some((slot, maps)) = held.zip(other.shadow_maps()) {
            self.set_shadow_maps(slot, maps);
        }
        self
    }

    /// Sets the shadow maps of the view.
    #[track_caller]
    pub(crate) fn set_shadow_maps(&mut self, slot: Slot, maps: ShadowMaps) {
        self.set(slot, maps.texture);
        self.shadow_view = Some(maps.view);
    }

    /// Returns the shadow maps: depth, or moments.
    pub fn shadow_maps(&self) -> Option<ShadowMaps> {
        let texture = self.find(Slot::SHADOW_MAP).or_else(|| self.find(Slot::SHADOW_MOMENTS))?;
        Some(ShadowMaps { texture, view: self.shadow_view.unwrap_or(self.view) })
    }

    /// Fails if the shadow maps were set without the view that they are drawn for.
    pub(crate) fn check_shadow_maps(&self) -> Result<(), StageError> {
        let held = self.held(Slot::SHADOW_MAP).or_else(|| self.held(Slot::SHADOW_MOMENTS));
        match held {
            Some(held) if self.shadow_view.is_none() => {
                Err(StageError::MapsOfUnknownView { stage: held.by, slot: held.slot.name, at: held.at })
            }
            _ => Ok(()),
        }
    }

    /// Returns the view.
    pub const fn view(&self) -> ViewId {
        self.view
    }

    /// Returns the size of the view's pictures.
    pub const fn extent(&self) -> Extent {
        self.extent
    }

    /// Returns the number of layers of the view's pictures: 2 for both eyes of a stereo view, otherwise 1.
    pub const fn layers(&self) -> u16 {
        self.layers
    }

    /// Returns the target for a stage that makes the picture ([`Stage::picture`](super::Stage::picture)): the frame's
    /// target for the last such stage, a new texture for earlier ones.
    pub const fn target(&self) -> Target {
        self.target
    }

    /// Returns the texture of a slot, if any.
    pub fn find(&self, slot: Slot) -> Option<Texture> {
        self.held(slot).map(|held| held.texture)
    }

    /// Slots with the same name are the same slot.
    fn held(&self, slot: Slot) -> Option<&Held> {
        self.slots.iter().find(|held| held.slot.name == slot.name)
    }

    /// Returns the texture of a slot.
    ///
    /// # Errors
    /// Fails if no stage set it.
    pub fn get(&self, slot: Slot) -> Result<Texture, StageError> {
        self.find(slot).ok_or(StageError::Missing { stage: self.stage, slot: slot.name })
    }

    /// Sets the texture of a slot for later stages. Every write makes a new handle; set that one.
    #[track_caller]
    pub fn set(&mut self, slot: Slot, texture: Texture) {
        let held = Held { slot, texture, by: self.stage, at: Location::caller(), checked: false };
        if [Slot::SHADOW_MAP.name, Slot::SHADOW_MOMENTS.name].contains(&slot.name) {
            self.shadow_view = None;
        }
        match self.slots.iter_mut().find(|held| held.slot.name == slot.name) {
            Some(own) => *own = held,
            None => self.slots.push(held),
        }
    }

    /// Returns the error of a stage that would resolve `samples` over the texture that another stage set in `slot`.
    pub(crate) fn lost(&self, slot: Slot, samples: Slot) -> StageError {
        let by = self.held(slot).map_or("", |held| held.by);
        StageError::Lost { stage: self.stage, slot: slot.name, samples: samples.name, by }
    }

    /// Begins a stage, which errors then name, and which makes its picture in `target`.
    pub(super) fn begin(&mut self, stage: &'static str, target: Target) {
        self.stage = stage;
        self.target = target;
    }

    /// Checks textures set since the last check against their slots.
    pub(super) fn check(&mut self, graph: &Graph) -> Result<(), StageError> {
        for held in self.slots.iter_mut().filter(|held| !held.checked) {
            let Held { slot, texture, by: stage, at, .. } = *held;
            let resource = graph.resource_of(texture).ok_or(StageError::Foreign { stage, slot: slot.name, at })?;
            let desc = graph.resources()[resource.index()].desc.texture().copied();
            if let Some(fault) = desc.and_then(|desc| slot.fault(&desc, self.extent)) {
                let texture = graph.resource_name(resource).to_owned();
                return Err(StageError::Wrong { stage, slot: slot.name, texture, fault, at });
            }
            held.checked = true;
        }
        Ok(())
    }

    /// Fails if the picture is not in `target`.
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
