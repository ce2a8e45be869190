//! Why a texture could not be inspected.

use crate::device::readback::ReadbackError;
use crate::execute::error::ExecuteError;
use crate::inspect::request::VersionSelector;
use crate::named::Named;
use framegraph::{Aspect, CompileError, DeclareError, Format, ResourceId, sanitize};
use std::fmt;

/// A texture cannot be looked at. The frame under study and its plan are as they were.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum InspectError {
    /// No such resource.
    #[error("there is no texture `{shown}`; the frame has {}", listed(.known.iter().map(|known| format!("`{}`", sanitize::name(known)))), shown = sanitize::name(.name))]
    NoTexture {
        /// What was asked for.
        name: String,
        /// The textures that there are.
        known: Vec<String>,
    },
    /// The name is that of a buffer.
    #[error("`{shown}` is a buffer, which has no picture; read it with `read_buffer`", shown = sanitize::name(.name))]
    Buffer {
        /// What was asked for.
        name: String,
    },
    /// No such version.
    #[error("`{shown}` has no version {}; it has {}", asked_version(.asked, *.steps), listed(.known.iter().map(VersionName::to_string)), shown = sanitize::name(.name))]
    NoVersion {
        /// The inspected texture.
        name: String,
        /// What was asked for.
        asked: VersionSelector,
        /// How many steps the plan has.
        steps: usize,
        /// The versions that there are.
        known: Vec<VersionName>,
    },
    /// No such level, layer, plane or sample.
    #[error("`{shown}` has no {part}", shown = sanitize::name(.name))]
    NoPart {
        /// The inspected texture.
        name: String,
        /// What was asked for, and what there is.
        part: MissingPart,
    },
    /// An import that the frame writes over what it holds, and of which no copy can be made.
    #[error(
        "looking at `{shown}` runs passes that write the import `{import}`, and no copy of that can be made; create it with \
         COPY_SRC", shown = sanitize::name(.name))]
    Import {
        /// The texture asked for.
        name: String,
        /// The import, in the inspected graph.
        import: Named<ResourceId>,
    },
    /// The inspection's own pass was refused.
    #[error("`{shown}` cannot be read: {error}", shown = sanitize::name(.name))]
    Declare {
        /// The inspected texture.
        name: String,
        /// The reason.
        error: Box<DeclareError>,
    },
    /// The inspected frame does not compile: the part asked for was not written yet, mostly.
    #[error("`{shown}` cannot be looked at there: {error}", shown = sanitize::name(.name))]
    Compile {
        /// The inspected texture.
        name: String,
        /// The reason.
        error: Box<CompileError>,
    },
    /// The inspected frame could not be executed.
    #[error("looking at `{shown}`: {error}", shown = sanitize::name(.name))]
    Execute {
        /// The inspected texture.
        name: String,
        /// The reason.
        error: Box<ExecuteError>,
    },
    /// The result could not be read back.
    #[error("looking at `{shown}`: {error}", shown = sanitize::name(.name))]
    Readback {
        /// The inspected texture.
        name: String,
        /// The reason.
        error: Box<ReadbackError>,
    },
}

impl fmt::Debug for InspectError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// A part that a texture does not have.
#[derive(Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum MissingPart {
    /// A level, counted from 0.
    #[error("level {asked}; it has levels 0 to {}", .levels - 1)]
    Level {
        /// The level asked for.
        asked: u8,
        /// How many there are.
        levels: u32,
    },
    /// A layer of an array or slice of a three-dimensional texture, counted from 0.
    #[error("layer {asked}; it has layers 0 to {}", .layers - 1)]
    Layer {
        /// The layer asked for.
        asked: u16,
        /// How many there are.
        layers: u32,
    },
    /// A plane of a depth-stencil format.
    #[error("{asked:?} plane; it has the format {format:?}")]
    Plane {
        /// The plane asked for.
        asked: Aspect,
        /// The format of the texture.
        format: Format,
    },
    /// A sample of each texel, counted from 0.
    #[error("sample {asked}; it has {samples} samples")]
    Sample {
        /// The sample asked for.
        asked: u8,
        /// How many there are.
        samples: u8,
    },
}

impl fmt::Debug for MissingPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// A version of a texture: its number, and the full name of the pass that wrote it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VersionName {
    /// The contents on entry are 0.
    pub number: usize,
    /// None for the contents on entry.
    pub writer: Option<String>,
}

impl fmt::Display for VersionName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.writer {
            Some(writer) => write!(f, "v{} (`{}`)", self.number, sanitize::name(writer)),
            None => write!(f, "v{} (on entry)", self.number),
        }
    }
}

fn asked_version(asked: &VersionSelector, steps: usize) -> String {
    match asked {
        VersionSelector::Newest => "that a pass wrote".to_owned(),
        VersionSelector::After(pass) => format!("of a pass `{}`", sanitize::name(pass)),
        VersionSelector::Number(number) => format!("v{number}"),
        VersionSelector::Step(step) => format!("at step {step} of {steps}"),
    }
}

/// The first forty words, and how many more there are.
fn listed(words: impl Iterator<Item = String>) -> String {
    const LISTED: usize = 40;
    let all: Vec<_> = words.collect();
    match all.len() {
        0 => "none".to_owned(),
        n if n > LISTED => format!("{} and {} more", all[..LISTED].join(", "), n - LISTED),
        _ => all.join(", "),
    }
}
