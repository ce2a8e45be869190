//! Errors of inspecting a texture.

use crate::device::readback::ReadbackError;
use crate::execute::error::ExecuteError;
use crate::inspect::request::VersionSelector;
use crate::named::Named;
use framegraph::{Aspect, CompileError, DeclareError, Format, ResourceId, sanitize};
use std::fmt;

/// Error of an inspection. The original frame and its plan are not changed.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum InspectError {
    /// The resource does not exist.
    #[error("there is no texture `{shown}`; the frame has {}", listed(.known.iter().map(|known| format!("`{}`", sanitize::name(known)))), shown = sanitize::name(.name))]
    NoTexture {
        /// Requested name.
        name: String,
        /// Names of the textures that exist.
        known: Vec<String>,
    },
    /// The resource is a buffer.
    #[error("`{shown}` is a buffer, which cannot be shown as an image; read it with `read_buffer`", shown = sanitize::name(.name))]
    Buffer {
        /// Requested name.
        name: String,
    },
    /// The version does not exist.
    #[error("`{shown}` has no version {}; it has {}", version_text(.requested, *.steps), listed(.known.iter().map(VersionName::to_string)), shown = sanitize::name(.name))]
    NoVersion {
        /// Name of the texture.
        name: String,
        /// Requested version.
        requested: VersionSelector,
        /// Number of steps of the plan.
        steps: usize,
        /// Versions that exist.
        known: Vec<VersionName>,
    },
    /// The level, layer, plane or sample does not exist.
    #[error("`{shown}` has no {part}", shown = sanitize::name(.name))]
    NoPart {
        /// Name of the texture.
        name: String,
        /// Requested part, and the parts that exist.
        part: MissingPart,
    },
    /// The inspected frame writes an import that cannot be copied first.
    #[error(
        "inspecting `{shown}` runs passes that write the import `{import}`, which cannot be copied first; create it with \
         COPY_SRC", shown = sanitize::name(.name))]
    Import {
        /// Name of the texture.
        name: String,
        /// Import, in the inspected graph.
        import: Named<ResourceId>,
    },
    /// The inspection pass could not be declared.
    #[error("`{shown}` cannot be read: {error}", shown = sanitize::name(.name))]
    Declare {
        /// Name of the texture.
        name: String,
        /// Reason.
        error: Box<DeclareError>,
    },
    /// The inspected frame does not compile, usually because the requested part is not written at that point.
    #[error("`{shown}` cannot be inspected there: {error}", shown = sanitize::name(.name))]
    Compile {
        /// Name of the texture.
        name: String,
        /// Reason.
        error: Box<CompileError>,
    },
    /// The inspected frame could not be executed.
    #[error("inspecting `{shown}`: {error}", shown = sanitize::name(.name))]
    Execute {
        /// Name of the texture.
        name: String,
        /// Reason.
        error: Box<ExecuteError>,
    },
    /// The result could not be read back.
    #[error("inspecting `{shown}`: {error}", shown = sanitize::name(.name))]
    Readback {
        /// Name of the texture.
        name: String,
        /// Reason.
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
    /// Mip level, counted from 0.
    #[error("level {requested}; it has levels 0 to {}", .levels - 1)]
    Level {
        /// Requested level.
        requested: u8,
        /// Number of levels.
        levels: u32,
    },
    /// Layer of an array or slice of a 3D texture, counted from 0.
    #[error("layer {requested}; it has layers 0 to {}", .layers - 1)]
    Layer {
        /// Requested layer.
        requested: u16,
        /// Number of layers.
        layers: u32,
    },
    /// Plane of a depth-stencil format.
    #[error("{} plane; it has the format {format:?}", match .requested { Aspect::All => "color", Aspect::Depth => "depth", Aspect::Stencil => "stencil" })]
    Plane {
        /// Requested plane.
        requested: Aspect,
        /// Format of the texture.
        format: Format,
    },
    /// Sample of a multisampled texture, counted from 0.
    #[error("sample {requested}; it has {samples} samples")]
    Sample {
        /// Requested sample.
        requested: u8,
        /// Number of samples.
        samples: u8,
    },
}

impl fmt::Debug for MissingPart {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// Name of a version: its number, and the full name of the pass that wrote it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct VersionName {
    /// Version number; 0 for the contents on entry.
    pub number: usize,
    /// Pass that wrote the version; `None` for the contents on entry.
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

fn version_text(requested: &VersionSelector, steps: usize) -> String {
    match requested {
        VersionSelector::Newest => "that a pass wrote".to_owned(),
        VersionSelector::After(pass) => format!("of a pass `{}`", sanitize::name(pass)),
        VersionSelector::Number(number) => format!("v{number}"),
        VersionSelector::Step(step) => format!("at step {step} of {steps}"),
    }
}

/// Joins the first forty names and counts the rest.
fn listed(words: impl Iterator<Item = String>) -> String {
    const LISTED: usize = 40;
    let all: Vec<_> = words.collect();
    match all.len() {
        0 => "none".to_owned(),
        n if n > LISTED => format!("{} and {} more", all[..LISTED].join(", "), n - LISTED),
        _ => all.join(", "),
    }
}
