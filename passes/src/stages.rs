//! A frame as a list of named stages, each of which declares passes and hands textures on to those after it.
//!
//! A stage is inserted before or after another one by name, and one replaces another of its name; nothing is copied. What
//! stages hand on stands in [`Slot`]s: a few that the standard frame knows, and any that an application adds. A slot that
//! holds something else than it should, or nothing where a stage needs it, is an error that names stage and slot.
//!
//! ```
//! use framegraph::{Extent, Format, Intent, Target, TextureDesc};
//! use framegraph_passes::stages::{Handles, Slot, Stage};
//! use framegraph_passes::{Settings, World, stages};
//! use framegraph_wgpu::Frame;
//!
//! let mut frame = Frame::<World>::new();
//! let mut stages = stages(&Settings::default());
//! stages.insert_after("color", Stage::new("darken", |frame: &mut Frame<World>, handles: &mut Handles| {
//!     let (hdr, extent) = (handles.get(Slot::HDR)?, handles.extent());
//!     let darker = frame.add_fn(
//!         "darken",
//!         |pass| {
//!             pass.sampled(hdr)?;
//!             let darker = pass.texture("darker", TextureDesc::new(extent, Format::Rgba16Float));
//!             pass.color(darker, Intent::Overwrite)
//!         },
//!         |_, _, _| Ok(()), // draws
//!     )?;
//!     handles.set(Slot::HDR, darker);
//!     Ok(())
//! }))?;
//! let handles = stages.declare(&mut frame, Handles::default(), Target::New)?;
//! frame.graph_mut().export(handles.get(Slot::PICTURE)?);
//! let names: Vec<_> = frame.graph().pass_ids().map(|pass| frame.graph().pass_name(pass).to_owned()).collect();
//! assert_eq!(names, ["shadow", "prepass", "color", "darken", "post", "fxaa"]);
//! # Ok::<(), framegraph_passes::StageError>(())
//! ```

use crate::view::ViewId;
use framegraph::{DeclareError, Extent, Format, Graph, Target, Texture};
use framegraph_wgpu::Frame;
use std::fmt;

/// What a slot's texture is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Holds {
    /// Color of one sample per texel.
    Color,
    /// Color of one or more samples per texel.
    ColorSamples,
    /// Depth of one sample per texel.
    Depth,
    /// Depth of one or more samples per texel.
    DepthSamples,
}

/// A texture that stages hand on, by name. The constants are those of the standard frame; an application's own stages make
/// slots of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Slot {
    /// Name for messages; slots of one name are one slot.
    pub name: &'static str,
    /// What its texture is.
    pub holds: Holds,
}

impl Slot {
    /// The sun's shadow map, reversed depth. One that is there from the start is not made again.
    pub const SHADOW_MAP: Self = Self::new("shadow_map", Holds::Depth);
    /// Reversed depth of what is drawn so far, of as many samples as the frame has. For one sample per texel see
    /// [`single_sample_depth`](crate::depth_resolve::single_sample_depth).
    pub const DEPTH: Self = Self::new("depth", Holds::DepthSamples);
    /// Scene-referred radiance times exposure, linear Rec.709.
    pub const HDR: Self = Self::new("hdr", Holds::Color);
    /// The same, of each sample, where the frame has several per texel. The stage `transparent` draws into these and
    /// averages them into [`Slot::HDR`] anew: a stage between `color` and it that changes one has to hand on both.
    pub const HDR_SAMPLES: Self = Self::new("hdr_samples", Holds::ColorSamples);
    /// What is behind transmissive surfaces, a pyramid of radiance with distance in alpha; only where the scene transmits.
    pub const SCENE_LEVELS: Self = Self::new("scene_levels", Holds::Color);
    /// The picture for the display.
    pub const PICTURE: Self = Self::new("picture", Holds::Color);

    /// A slot.
    pub const fn new(name: &'static str, holds: Holds) -> Self {
        Self { name, holds }
    }

    /// What a texture of this format and sample count lacks to be held here.
    fn fault(self, format: Format, samples: u8) -> Option<SlotFault> {
        let depth = matches!(self.holds, Holds::Depth | Holds::DepthSamples);
        let single = matches!(self.holds, Holds::Color | Holds::Depth);
        if format.has_depth() != depth {
            Some(SlotFault::Format { format, depth })
        } else if single && samples > 1 {
            Some(SlotFault::Samples { samples })
        } else {
            None
        }
    }
}

/// Why a texture cannot be in a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SlotFault {
    /// It is depth where color is needed, or the other way around.
    Format {
        /// Its format.
        format: Format,
        /// Depth is needed.
        depth: bool,
    },
    /// It has several samples per texel where one is needed.
    Samples {
        /// Its samples per texel.
        samples: u8,
    },
}

impl fmt::Display for SlotFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Format { format, depth: true } => write!(f, "its format is {format:?}, and a depth format is needed"),
            Self::Format { format, depth: false } => {
                write!(f, "its format is {format:?}, and a color format is needed")
            }
            Self::Samples { samples } => write!(f, "it has {samples} samples per texel, and one is needed; resolve it"),
        }
    }
}

/// A list of stages cannot be changed or declared as asked.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum StageError {
    /// No stage has that name.
    #[error("there is no stage `{name}`; the stages are {}", .known.join(", "))]
    Unknown {
        /// The name asked for.
        name: String,
        /// The names that there are, in order.
        known: Vec<&'static str>,
    },
    /// Another stage has that name.
    #[error("there is a stage `{name}` already; choose another name, or replace it")]
    Twice {
        /// The name.
        name: &'static str,
    },
    /// A stage needs what no stage has handed on.
    #[error("stage `{stage}` needs `{slot}`, which no stage before it handed on (`Handles::set`)")]
    Missing {
        /// The stage; empty after the last one.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
    },
    /// A stage handed on a handle of another frame.
    #[error("stage `{stage}` handed on a `{slot}` of another frame, or of before this one was reset")]
    Foreign {
        /// The stage.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
    },
    /// A stage handed on a texture that the slot cannot hold.
    #[error("stage `{stage}` handed on `{texture}` as `{slot}`: {fault}")]
    Wrong {
        /// The stage.
        stage: &'static str,
        /// Name of the slot.
        slot: &'static str,
        /// Full name of the texture.
        texture: String,
        /// Why not.
        fault: SlotFault,
    },
    /// A stage would write over what an earlier one wrote.
    #[error(
        "stage `{stage}` draws into `{samples}` and averages that into `{slot}`, which would lose what stage `{by}` wrote; \
         insert that stage after `{stage}`, or hand on `{samples}` with the same in it, and `{slot}` as its average"
    )]
    Lost {
        /// The stage that would write.
        stage: &'static str,
        /// Name of the slot whose texture would be written over.
        slot: &'static str,
        /// Name of the slot of its samples.
        samples: &'static str,
        /// The stage that handed the texture on.
        by: &'static str,
    },
    /// The picture did not end where the frame's picture is to go.
    #[error(
        "stage `{stage}` left the picture in `{texture}`, which is not the frame's target; make the stage with \
         `Stage::picture`, and draw into `Handles::target`"
    )]
    OtherTarget {
        /// The stage that handed the picture on last.
        stage: &'static str,
        /// Full name of the texture.
        texture: String,
    },
    /// A pass was refused.
    #[error(transparent)]
    Declare(#[from] DeclareError),
}

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
        Self { view, extent, slots: Vec::with_capacity(8), stage: "the caller", target: Target::New }
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

    /// Where a stage that makes the picture ([`Stage::picture`]) is to put it: the frame's target for the last such stage, a
    /// new texture for those before.
    pub const fn target(&self) -> Target {
        self.target
    }

    /// What a slot holds, if anything.
    pub fn find(&self, slot: Slot) -> Option<Texture> {
        self.slots.iter().find(|held| held.slot.name == slot.name).map(|held| held.texture)
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
        let by = self.slots.iter().find(|held| held.slot.name == slot.name).map_or("", |held| held.by);
        StageError::Lost { stage: self.stage, slot: slot.name, samples: samples.name, by }
    }

    /// Refuses what was handed on since the last check and is not what its slot holds.
    fn check(&mut self, graph: &Graph) -> Result<(), StageError> {
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
    fn check_target(&self, graph: &Graph, target: Target) -> Result<(), StageError> {
        let (Target::Into(part), Some(picture)) = (target, self.slots.iter().find(|h| h.slot == Slot::PICTURE)) else {
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

type Declare<W> = dyn Fn(&mut Frame<W>, &mut Handles) -> Result<(), StageError> + Send + Sync;

/// Passes that are declared together, under a name.
pub struct Stage<W: ?Sized + 'static> {
    name: &'static str,
    picture: bool,
    declare: Box<Declare<W>>,
}

impl<W: ?Sized + 'static> Stage<W> {
    /// A stage that declares what `declare` adds to the frame. It takes textures from the handles and hands on what it
    /// wrote.
    pub fn new(
        name: &'static str,
        declare: impl Fn(&mut Frame<W>, &mut Handles) -> Result<(), StageError> + Send + Sync + 'static,
    ) -> Self {
        Self { name, picture: false, declare: Box::new(declare) }
    }

    /// A stage that makes the picture for the display, [`Slot::PICTURE`], and puts it into [`Handles::target`].
    pub fn picture(
        name: &'static str,
        declare: impl Fn(&mut Frame<W>, &mut Handles) -> Result<(), StageError> + Send + Sync + 'static,
    ) -> Self {
        Self { picture: true, ..Self::new(name, declare) }
    }
}

impl<W: ?Sized + 'static> fmt::Debug for Stage<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, picture, .. } = self;
        f.debug_struct("Stage").field("name", name).field("picture", picture).finish_non_exhaustive()
    }
}

/// The stages of a frame, in order. May be declared again and again, in several frames, for several views.
#[derive(Debug)]
pub struct Stages<W: ?Sized + 'static>(Vec<Stage<W>>);

impl<W: ?Sized + 'static> Default for Stages<W> {
    /// No stage.
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<W: ?Sized + 'static> Stages<W> {
    /// Stages of names that differ.
    pub(crate) fn of(stages: impl IntoIterator<Item = Stage<W>>) -> Self {
        Self(stages.into_iter().collect())
    }

    /// Names of the stages, in order.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.0.iter().map(|stage| stage.name)
    }

    /// Adds a stage at the end.
    ///
    /// # Errors
    /// When there is one of its name.
    pub fn push(&mut self, stage: Stage<W>) -> Result<&mut Self, StageError> {
        self.insert(self.0.len(), stage)
    }

    /// Inserts a stage directly before the one of name `before`.
    ///
    /// # Errors
    /// When there is no stage of that name, or one of the new stage's name.
    pub fn insert_before(&mut self, before: &str, stage: Stage<W>) -> Result<&mut Self, StageError> {
        let at = self.position(before)?;
        self.insert(at, stage)
    }

    /// Inserts a stage directly after the one of name `after`.
    ///
    /// # Errors
    /// As [`Stages::insert_before`].
    pub fn insert_after(&mut self, after: &str, stage: Stage<W>) -> Result<&mut Self, StageError> {
        let at = self.position(after)?;
        self.insert(at + 1, stage)
    }

    /// Puts a stage in the place of the one of its name.
    ///
    /// # Errors
    /// When there is none.
    pub fn replace(&mut self, stage: Stage<W>) -> Result<&mut Self, StageError> {
        let at = self.position(stage.name)?;
        self.0[at] = stage;
        Ok(self)
    }

    /// Declares all stages in order, starting from `handles`, the picture going into `target`. Returns what the stages
    /// handed on.
    ///
    /// # Errors
    /// What a stage refuses or hands on wrongly. The frame then holds the passes before; reset it.
    pub fn declare(&self, frame: &mut Frame<W>, handles: Handles, target: Target) -> Result<Handles, StageError> {
        let mut handles = handles;
        handles.check(frame.graph())?;
        let last = self.0.iter().rposition(|stage| stage.picture);
        for (index, stage) in self.0.iter().enumerate() {
            handles.stage = stage.name;
            handles.target = if last == Some(index) { target } else { Target::New };
            (stage.declare)(frame, &mut handles)?;
            handles.check(frame.graph())?;
        }
        handles.check_target(frame.graph(), target)?;
        handles.stage = "the caller";
        Ok(handles)
    }

    fn position(&self, name: &str) -> Result<usize, StageError> {
        let unknown = || StageError::Unknown { name: name.to_owned(), known: self.names().collect() };
        self.names().position(|own| own == name).ok_or_else(unknown)
    }

    fn insert(&mut self, at: usize, stage: Stage<W>) -> Result<&mut Self, StageError> {
        if self.names().any(|name| name == stage.name) {
            return Err(StageError::Twice { name: stage.name });
        }
        self.0.insert(at, stage);
        Ok(self)
    }
}
