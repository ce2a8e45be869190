//! What can be wrong with a declaration, said with the names involved, the place in code and what to do about it.

use crate::access::{AccessKind, Range};
use crate::format::Format;
use crate::graph::rows::PassKind;
use crate::id::{PassId, ResourceId};
use crate::resource::TextureDesc;
use std::fmt;
use std::panic::Location;

/// A pass or resource that an error is about. The name comes along, since an error outlives what was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Named<I> {
    /// Its id in the graph; of a refused pass and what it made, the id that was taken back.
    pub id: I,
    /// Its full name.
    pub name: String,
}

/// A call that declares something was refused; nothing of it stays in the graph.
#[derive(Clone, PartialEq, Eq)]
pub struct DeclareError {
    /// What was wrong.
    pub reason: DeclareReason,
    /// The pass that was being declared; none for a call on the graph itself.
    pub pass: Option<Named<PassId>>,
    /// The resource concerned, where there is one.
    pub resource: Option<Named<ResourceId>>,
    /// Where the call was made.
    pub location: &'static Location<'static>,
}

impl fmt::Debug for DeclareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// Why a declaration was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DeclareReason {
    /// The handle names an older version: the named pass has written a newer one.
    Stale {
        /// The name of the pass that wrote the newest version.
        writer: String,
    },
    /// The handle is of another graph, or of this one before its last reset.
    Foreign,
    /// The range lies outside of the texture.
    OutOfRange {
        /// What was asked.
        asked: Range,
        /// What there is.
        texture: TextureDesc,
    },
    /// An earlier image was asked of a resource that keeps none so old.
    NoHistory {
        /// How many frames back, from 1.
        age: u8,
        /// How many earlier frames the history keeps; none for a resource that is no history.
        frames: Option<u8>,
    },
    /// A history of no earlier frame.
    EmptyHistory,
    /// A second history of the same full name.
    HistoryTwice,
    /// The pass already touches the same part in a way that excludes this.
    Conflict {
        /// The earlier access.
        earlier: AccessKind,
        /// The refused access.
        later: AccessKind,
    },
    /// A write to the image that an earlier frame left.
    WritesEarlierFrame {
        /// The access.
        access: AccessKind,
    },
    /// A read with an access that writes, or a write with one that reads.
    WrongDirection {
        /// The access.
        access: AccessKind,
    },
    /// The format cannot be used that way.
    Format {
        /// The format.
        format: Format,
        /// The access.
        access: AccessKind,
    },
    /// A buffer cannot be used that way.
    Buffer {
        /// The access.
        access: AccessKind,
    },
    /// An attachment must be one level of one range of layers.
    NotOneLevel {
        /// The access.
        access: AccessKind,
    },
    /// A level of several slices of a three-dimensional texture is attached or read at the same pixel: contents are not
    /// followed slice by slice.
    Slices {
        /// The access.
        access: AccessKind,
    },
    /// A second depth attachment.
    SecondDepth,
    /// A color slot is taken.
    SlotTaken {
        /// The slot.
        slot: u8,
    },
    /// More color attachments than any device has.
    TooManyColors,
    /// A resolve target without a multisampled color attachment in that pass.
    NothingToResolve,
    /// The pass is of a kind that cannot make this access.
    WrongPassKind {
        /// The kind that was asked for.
        kind: PassKind,
        /// The access.
        access: AccessKind,
    },
    /// The pass copies, and also does what copy passes cannot.
    MixedKinds {
        /// The earlier access.
        earlier: AccessKind,
        /// The name of the resource of the earlier access.
        of: String,
        /// The refused access.
        later: AccessKind,
    },
    /// The pass's own reason.
    Custom {
        /// What is wrong.
        message: String,
        /// What to do.
        hint: String,
    },
}

impl DeclareReason {
    /// What is wrong, without names of pass and resource; and what to do about it.
    fn words(&self) -> (String, String) {
        let (sentence, hint): (String, &str) = match self {
            Self::Stale { writer } => {
                let hint = format!("use the handle that `{writer}` returned, or declare this pass before it");
                return (format!("the handle is stale: pass `{writer}` has written a newer version"), hint);
            }
            Self::Custom { message, hint } => return (message.clone(), hint.clone()),
            Self::Foreign => (
                "the handle is of another graph, or from before this graph was reset".into(),
                "declare the resource in this graph, and anew after each reset",
            ),
            Self::OutOfRange { asked, texture: TextureDesc { mips, layers, format, .. } } => (
                format!("{} was asked of {mips} levels, {layers} layers, {format:?}", described(asked)),
                "ask for levels and layers that the descriptor has",
            ),
            Self::NoHistory { age, frames: Some(frames) } => (
                format!("frame −{age} was asked of a history of {frames} frames"),
                "give the history as many frames, or ask for a later one",
            ),
            Self::NoHistory { frames: None, .. } => {
                ("the resource is not a history".into(), "declare it with `Graph::history`")
            }
            Self::EmptyHistory => ("a history keeps at least one earlier frame".into(), "give it 1 frame or more"),
            Self::HistoryTwice => (
                "another history has this name, by which its images are found again in the next frame".into(),
                "name them apart, or declare each in a scope of its own",
            ),
            Self::Conflict { earlier, later } => (
                format!("`{}` touches a part that the same pass already uses as `{}`", later.word(), earlier.word()),
                "split the pass in two, or use different mip levels or layers",
            ),
            Self::WritesEarlierFrame { access } => (
                format!("`{}` writes the image that an earlier frame left", access.word()),
                "write the history itself, which is the image of this frame",
            ),
            Self::WrongDirection { access } => (
                format!("`{}` does not go in that direction", access.word()),
                "read with an access that reads, write with one that writes",
            ),
            Self::Format { format, access } => (
                format!("format {format:?} cannot be used as `{}`", access.word()),
                "choose a format with that capability",
            ),
            Self::Buffer { access } => {
                (format!("a buffer cannot be used as `{}`", access.word()), "use a texture, or another access")
            }
            Self::NotOneLevel { access } => {
                (format!("`{}` must name one mip level", access.word()), "name the level: `texture.mip(n)`")
            }
            Self::Slices { access } => (
                format!("`{}` of a level that has several slices", access.word()),
                "write it as storage or by a copy, or draw into the layers of a two-dimensional texture",
            ),
            Self::SecondDepth => ("a pass has one depth attachment".into(), "split the pass in two"),
            Self::SlotTaken { slot } => {
                (format!("color slot {slot} is taken"), "let `color` choose the slot, or name a free one")
            }
            Self::TooManyColors => (
                "a pass has at most 8 color attachments".into(),
                "split the pass, or pack outputs into fewer attachments",
            ),
            Self::NothingToResolve => (
                "the pass has no multisampled color attachment of that handle".into(),
                "declare the multisampled color attachment first and pass the handle it returned",
            ),
            Self::WrongPassKind { kind, access } => (
                format!("a {} pass cannot use `{}`", kind.word(), access.word()),
                "leave the kind to the accesses, or split the pass",
            ),
            Self::MixedKinds { earlier, of, later } => (
                format!("`{}` cannot be in one pass with `{}` of `{of}`", later.word(), earlier.word()),
                "put the copies into a pass of their own",
            ),
        };
        (sentence, hint.into())
    }

    /// What is wrong, without the names of pass and resource.
    pub fn sentence(&self) -> String {
        self.words().0
    }

    /// What to do about it.
    pub fn hint(&self) -> String {
        self.words().1
    }
}

/// A range in words.
fn described(range: &Range) -> String {
    let count = |first: u32, count: u32, all: bool| {
        if all { format!("{first}..") } else { format!("{first}..{}", first + count) }
    };
    let mips = count(range.mip.into(), range.mips.into(), range.mips == u8::MAX);
    let layers = count(range.layer.into(), range.layers.into(), range.layers == u16::MAX);
    format!("levels {mips}, layers {layers}, aspect {:?}", range.aspect)
}

/// Writes whom an error is about, each with a colon behind it.
pub(crate) fn about(f: &mut impl fmt::Write, pass: Option<&str>, resource: Option<&str>) -> fmt::Result {
    if let Some(pass) = pass {
        write!(f, "pass `{pass}`: ")?;
    }
    resource.map_or(Ok(()), |resource| write!(f, "resource `{resource}`: "))
}

impl fmt::Display for DeclareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reason, pass, resource, location } = self;
        about(f, pass.as_ref().map(|p| p.name.as_str()), resource.as_ref().map(|r| r.name.as_str()))?;
        let (sentence, hint) = reason.words();
        write!(f, "{sentence} (at {}:{}); {hint}", location.file(), location.line())
    }
}

impl std::error::Error for DeclareError {}
