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
//! frame.graph_mut().export(handles.get(Slot::PICTURE)?)?;
//! let names: Vec<_> = frame.graph().pass_ids().map(|pass| frame.graph().pass_name(pass).to_owned()).collect();
//! assert_eq!(names, ["shadow", "prepass", "color", "darken", "post", "fxaa"]);
//! # Ok::<(), framegraph_passes::StageError>(())
//! ```

mod error;
mod handles;
mod slot;

pub use error::StageError;
pub use handles::Handles;
pub use slot::{Holds, Slot, SlotFault};

use framegraph::Target;
use framegraph_wgpu::Frame;
use std::fmt;

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
            handles.begin(stage.name, if last == Some(index) { target } else { Target::New });
            (stage.declare)(frame, &mut handles)?;
            handles.check(frame.graph())?;
        }
        handles.check_target(frame.graph(), target)?;
        handles.begin(handles::CALLER, Target::New);
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
