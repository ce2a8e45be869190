//! A frame as a list of named stages that declare passes and exchange textures.
//!
//! Stages are inserted before or after a stage, and replaced, by name. Textures are exchanged through [`Slot`]s:
//! those of the standard frame, and any that an application adds. A missing or unsuitable texture is an error that
//! names stage and slot.
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

/// Named group of passes that are declared together.
pub struct Stage<W: ?Sized> {
    name: &'static str,
    picture: bool,
    declare: Box<Declare<W>>,
}

impl<W: ?Sized> Stage<W> {
    /// Creates a stage. `declare` takes textures from the handles, adds passes to the frame, and sets the textures it
    /// wrote.
    pub fn new(
        name: &'static str,
        declare: impl Fn(&mut Frame<W>, &mut Handles) -> Result<(), StageError> + Send + Sync + 'static,
    ) -> Self {
        Self { name, picture: false, declare: Box::new(declare) }
    }

    /// Creates a stage that makes the picture for the display, [`Slot::PICTURE`], in [`Handles::target`].
    pub fn picture(
        name: &'static str,
        declare: impl Fn(&mut Frame<W>, &mut Handles) -> Result<(), StageError> + Send + Sync + 'static,
    ) -> Self {
        Self { picture: true, ..Self::new(name, declare) }
    }
}

impl<W: ?Sized> fmt::Debug for Stage<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, picture, .. } = self;
        f.debug_struct("Stage").field("name", name).field("picture", picture).finish_non_exhaustive()
    }
}

/// Stages of a frame, in order. Can be declared repeatedly, in several frames and for several views.
#[derive(Debug)]
pub struct Stages<W: ?Sized>(Vec<Stage<W>>);

impl<W: ?Sized> Default for Stages<W> {
    /// Creates an empty list.
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<W: ?Sized> Stages<W> {
    /// Creates a list of stages with distinct names.
    pub(crate) fn of(stages: impl IntoIterator<Item = Stage<W>>) -> Self {
        Self(stages.into_iter().collect())
    }

    /// Returns the names of the stages, in order.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.0.iter().map(|stage| stage.name)
    }

    /// Appends a stage.
    ///
    /// # Errors
    /// Fails if a stage has the same name.
    pub fn push(&mut self, stage: Stage<W>) -> Result<&mut Self, StageError> {
        self.insert(self.0.len(), stage)
    }

    /// Inserts a stage directly before the stage named `before`.
    ///
    /// # Errors
    /// Fails if no stage has that name, or another has the name of the new stage.
    pub fn insert_before(&mut self, before: &str, stage: Stage<W>) -> Result<&mut Self, StageError> {
        let at = self.position(before)?;
        self.insert(at, stage)
    }

    /// Inserts a stage directly after the stage named `after`.
    ///
    /// # Errors
    /// Fails as [`Stages::insert_before`] does.
    pub fn insert_after(&mut self, after: &str, stage: Stage<W>) -> Result<&mut Self, StageError> {
        let at = self.position(after)?;
        self.insert(at + 1, stage)
    }

    /// Replaces the stage with the same name.
    ///
    /// # Errors
    /// Fails if there is none.
    pub fn replace(&mut self, stage: Stage<W>) -> Result<&mut Self, StageError> {
        let at = self.position(stage.name)?;
        self.0[at] = stage;
        Ok(self)
    }

    /// Declares all stages in order, starting from `handles`, with the picture in `target`. Returns the handles after
    /// the last stage.
    ///
    /// # Errors
    /// Returns the error of a stage. The frame then holds the passes declared so far; reset it.
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
