//! What can be wrong with a declaration, said with the names involved, the place in code and what to do about it.

mod forward;

use crate::access::{AccessKind, Range};
use crate::format::Format;
use crate::graph::rows::PassKind;
use crate::id::{PassId, ResourceId};
use crate::plain::line;
use crate::resolve::ResolveMode;
use crate::resource::TextureDesc;
pub use forward::ForwardFault;
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

/// Why a declaration was refused.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DeclareReason {
    /// The handle names an older version: the named pass has written a newer one.
    Stale {
        /// The name of the pass that wrote the newest version.
        writer: String,
        /// Who uses the handle.
        user: StaleUser,
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
        /// Of a buffer; otherwise of a texture.
        buffer: bool,
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
    /// A texture cannot be used that way.
    Texture {
        /// The access.
        access: AccessKind,
    },
    /// Bytes that the buffer has not.
    NoSuchBytes {
        /// The first byte that was asked for.
        offset: u64,
        /// How many.
        bytes: u64,
        /// How many the buffer has; none where that follows the frame.
        size: Option<u64>,
    },
    /// A texture cannot be seen through that format: it is not its own, nor the sRGB twin of that.
    NoTwin {
        /// Its own format.
        format: Format,
        /// The format that was asked for.
        view: Format,
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
    /// A color slot that no device has.
    NoSuchSlot {
        /// The slot.
        slot: u8,
    },
    /// More color attachments than any device has.
    TooManyColors,
    /// A resolve target without a multisampled color or depth attachment in that pass.
    NothingToResolve,
    /// Samples of that format cannot be resolved so.
    ResolveMode {
        /// The mode that was asked for.
        mode: ResolveMode,
        /// The format of the samples.
        format: Format,
    },
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
    /// A texture cannot be forwarded like that.
    Forward(ForwardFault),
    /// The pass's own reason.
    Custom {
        /// What is wrong.
        message: String,
        /// What to do.
        hint: String,
    },
}

/// Who uses a stale handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StaleUser {
    /// Another pass than the one that wrote the newest version.
    OtherPass,
    /// The pass itself that wrote it, after that.
    SamePass,
    /// A call on the graph: an export.
    Graph,
}

/// What to do instead of two accesses of one pass that exclude each other.
fn instead(earlier: AccessKind, later: AccessKind, buffer: bool) -> &'static str {
    use AccessKind as K;
    let either = |wanted: fn(AccessKind) -> bool| wanted(earlier) || wanted(later);
    if buffer {
        return "write it with `Modify` if the pass needs what it holds, or split the pass in two";
    }
    let reads = either(|k| matches!(k, K::Sampled | K::StorageRead | K::SamePixel));
    if reads && either(|k| matches!(k, K::Color | K::Resolve)) {
        "color cannot be attached and read at once, also where it is only blended with: declare `Modify` alone to build on \
         it, or read a copy, or other levels or layers"
    } else if reads && either(|k| k == K::Depth) {
        "declare `depth_read_only` in place of `depth` if the pass only tests, or read a copy"
    } else if reads && either(|k| k == K::StorageWrite) {
        "declare `storage_write` with `Modify` alone if the pass reads what it writes, or use other levels or layers"
    } else {
        "split the pass in two, or use different mip levels or layers"
    }
}

impl DeclareReason {
    /// What is wrong, without names of pass and resource; and what to do about it.
    fn words(&self) -> (String, String) {
        let (sentence, hint): (String, &str) = match self {
            Self::Stale { writer, user } => {
                let hint = match user {
                    StaleUser::OtherPass => {
                        format!("use the handle that `{writer}` returned, or declare this pass before it")
                    }
                    StaleUser::SamePass => "use the handle that the earlier write of this pass returned".into(),
                    StaleUser::Graph => format!("use the handle that `{writer}` returned"),
                };
                return (format!("the handle is stale: pass `{writer}` has written a newer version"), hint);
            }
            Self::Custom { message, hint } => return (message.clone(), hint.clone()),
            Self::Foreign => (
                "the handle is of another graph, or from before this graph was reset".into(),
                "declare the resource in this graph, and anew after each reset",
            ),
            Self::OutOfRange { asked, texture: TextureDesc { mips, layers, format, .. } } => (
                format!("{} was asked of {mips} levels, {layers} layers, {format:?}", described(asked)),
                "ask for levels, layers and planes that the texture has",
            ),
            Self::NoHistory { age: 0, frames: Some(_) } => {
                ("frame −0 was asked of a history".into(), "use the history itself: it is the image of this frame")
            }
            Self::NoHistory { age, frames: Some(frames) } => (
                format!("frame −{age} was asked of a history of {frames} frames"),
                "give the history as many frames, or ask for a more recent one",
            ),
            Self::NoHistory { frames: None, .. } => (
                "the resource is not a history".into(),
                "declare it with `Graph::history`, in a file with `kind: History(frames: 1)`",
            ),
            Self::EmptyHistory => ("a history keeps at least one earlier frame".into(), "give it 1 frame or more"),
            Self::HistoryTwice => (
                "another history has this name, by which its images are found again in the next frame".into(),
                "name them apart, or declare each in a scope of its own",
            ),
            Self::Conflict { earlier, later, buffer } => (
                format!("`{}` touches a part that the same pass already uses as `{}`", later.word(), earlier.word()),
                instead(*earlier, *later, *buffer),
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
                match access {
                    AccessKind::StorageRead | AccessKind::StorageWrite if format.is_srgb() => {
                        "use the format without sRGB, and look at it with `viewed_as` where it is sampled"
                    }
                    _ => "choose a format with that capability",
                },
            ),
            Self::Buffer { access } => {
                (format!("a buffer cannot be used as `{}`", access.word()), "use a texture, or another access")
            }
            Self::Texture { access } => {
                (format!("a texture cannot be used as `{}`", access.word()), "use a buffer, or another access")
            }
            Self::Slices { access } => (
                format!("`{}` of a level that has several slices", access.word()),
                "write it as storage or by a copy, or draw into the layers of a two-dimensional texture",
            ),
            Self::NoSuchBytes { offset, bytes, size } => (
                match size {
                    Some(size) => format!("{bytes} bytes from {offset} on were asked of a buffer of {size}"),
                    None => format!("{bytes} bytes from {offset} on were asked of a buffer"),
                },
                "ask for one byte or more, all of them inside of the buffer",
            ),
            Self::NoTwin { format, view } => (
                format!("a texture of {format:?} cannot be seen as {view:?}"),
                "view it in its own format, or in the one that differs in the sRGB transfer function alone",
            ),
            Self::NotOneLevel { access } => (
                format!("`{}` must name one mip level", access.word()),
                "name the level: `texture.mip(n)`, in a file `mip: n`",
            ),
            Self::Forward(fault) => fault.words(),
            Self::SecondDepth => ("a pass has one depth attachment".into(), "split the pass in two"),
            Self::SlotTaken { slot } => (
                format!("color slot {slot} is taken"),
                "leave the slot to `color`, in a file leave it out, or name a free one",
            ),
            Self::NoSuchSlot { slot } => (format!("there is no color slot {slot}"), "name a slot from 0 to 7"),
            Self::TooManyColors => (
                "a pass has at most 8 color attachments".into(),
                "split the pass, or pack outputs into fewer attachments",
            ),
            Self::NothingToResolve => (
                "the pass has no multisampled color or depth attachment of that handle".into(),
                "declare the attachment before its resolve, and resolve the handle that it returned, in a file its slot, or \
                 `of: Depth`",
            ),
            Self::ResolveMode { mode, format } => (
                format!("samples of {format:?} cannot be resolved by `{}`", mode.word()),
                match format.has_depth() || format.is_color_renderable() {
                    true => "resolve it by `Sample0`, `Min` or `Max`: depth and integers have no average",
                    false => "resolve a color or depth attachment: stencil stays with its samples",
                },
            ),
            Self::WrongPassKind { kind, access } => (
                format!("a {} pass cannot use `{}`", kind.word(), access.word()),
                match access {
                    AccessKind::CopySource | AccessKind::CopyTarget => "make it a copy pass, or split it",
                    access if access.needs_raster() => "make it a raster pass, or split it",
                    _ => "make it a raster or compute pass, or split it",
                },
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

/// Whom an error is about, each with a colon behind it.
pub(crate) fn about(pass: Option<&str>, resource: Option<&str>) -> String {
    let pass = pass.map(|pass| format!("pass `{pass}`: ")).unwrap_or_default();
    resource.map(|resource| format!("{pass}resource `{resource}`: ")).unwrap_or(pass)
}

impl fmt::Display for DeclareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reason, pass, resource, location } = self;
        let whom = about(pass.as_ref().map(|p| p.name.as_str()), resource.as_ref().map(|r| r.name.as_str()));
        let (sentence, hint) = reason.words();
        f.write_str(&line(&format!("{whom}{sentence} (at {}:{}); {hint}", location.file(), location.line())))
    }
}

impl fmt::Debug for DeclareError {
    /// The sentence, since that is what an `unwrap` shows.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for DeclareError {}
