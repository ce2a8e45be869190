//! Errors of declarations, with the names involved, the source location and a hint.

mod forward;

use crate::access::{AccessKind, Range};
use crate::error_macros::{error_enum, impl_error, show};
use crate::format::Format;
use crate::graph::rows::PassKind;
use crate::id::{PassId, ResourceId};
use crate::resolve::ResolveMode;
use crate::resource::TextureDesc;
pub use forward::ForwardReason;
use std::fmt;
use std::panic::Location;

/// The pass or resource that an error refers to. Contains its name, because the error may outlive it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Named<I> {
    /// Id in the graph. For a rejected pass and its resources, the id is no longer valid.
    pub id: I,
    /// Full name.
    pub name: String,
}

/// Error of a method that declares something. Nothing of the call stays in the graph.
#[derive(Clone, PartialEq, Eq)]
pub struct DeclareError {
    /// The error.
    pub reason: DeclareReason,
    /// The pass being declared; `None` for a method of the graph.
    pub pass: Option<Named<PassId>>,
    /// The resource concerned, if any.
    pub resource: Option<Named<ResourceId>>,
    /// Source location of the call.
    pub location: &'static Location<'static>,
}

error_enum! {
    /// Reason why a declaration is invalid. `asked` is the argument of the call, `later` the rejected access.
    DeclareReason {
        /// The handle refers to an older version.
        Stale { writer: String, user: StaleUser }
            "the handle is stale: pass `{writer}` has written a newer version", "use the handle that {use_instead}",
            use_instead = match user {
                StaleUser::OtherPass => format!("`{writer}` returned, or declare this pass before it"),
                StaleUser::SamePass => "the earlier write of this pass returned".into(),
                StaleUser::Graph => format!("`{writer}` returned"),
            };
        Foreign "the handle belongs to another graph, or to this graph before a reset",
            "declare the resource in this graph, and again after each reset";
        /// The range exceeds the texture.
        OutOfRange { asked: Range, texture: TextureDesc }
            "the range ({range}) exceeds the texture ({mips} levels, {layers} layers, {format:?})",
            "use levels, layers and planes of the texture",
            range = described(asked), TextureDesc { mips, layers, format, .. } = texture;
        /// The history does not keep an image of that age.
        NoHistory {
            /// Age in frames.
            age: u8,
            /// Number of earlier frames that the history keeps; `None` if the resource is not a history.
            frames: Option<u8>
        } => no_history(*age, *frames);
        EmptyHistory "a history must keep at least one earlier frame", "set `frames` to 1 or more";
        NoAlias "`may_alias` needs two different imports that are kept, both textures or both buffers",
            "import two textures or two buffers with `Exit::Keep`, and pass a handle of each";
        HistoryTwice "two histories have this name, but the back end identifies histories by name",
            "use different names or scopes";
        Conflict { earlier: AccessKind, later: AccessKind, /** Of a buffer; otherwise of a texture. */ buffer: bool }
            "`{later}` conflicts with `{earlier}` of the same pass: both access the same part", "{hint}",
            hint = instead(*earlier, *later, *buffer);
        WritesEarlierFrame { access: AccessKind } "`{access}` writes the history image of an earlier frame",
            "write the history itself, the image of this frame";
        WrongDirection { access: AccessKind } "`{access}` has the wrong direction",
            "use a read access to read and a write access to write";
        Format { format: Format, access: AccessKind } "format {format:?} cannot be used as `{access}`", "{hint}",
            hint = match access {
                AccessKind::StorageRead | AccessKind::StorageWrite if format.is_srgb() => {
                    "use the format without sRGB, and sample it with `viewed_as`"
                }
                _ => "choose a format with that capability",
            };
        Buffer { access: AccessKind } "a buffer cannot be used as `{access}`", "use a texture, or another access";
        Texture { access: AccessKind } "a texture cannot be used as `{access}`", "use a buffer, or another access";
        NoSuchBytes { offset: u64, bytes: u64, /** None where it follows the frame. */ size: Option<u64> }
            "{bytes} bytes at offset {offset} are not a valid range of a buffer{of}",
            "use a range of at least one byte inside of the buffer",
            of = size.map(|size| format!(" of {size}")).unwrap_or_default();
        NoTwin { format: Format, view: Format } "a texture of {format:?} cannot be viewed as {view:?}",
            "view it in its own format or the sRGB twin of it";
        NotOneLevel { access: AccessKind } "`{access}` needs a single mip level",
            "select the level: `texture.mip(n)`, in a file `mip: n`";
        /// Only color attachments select a slice of a three-dimensional texture, and exactly one.
        Slices { access: AccessKind } "`{access}` cannot use {which} of a three-dimensional texture", "{hint}",
            (which, hint) = match access {
                AccessKind::Color => (
                    "several slices",
                    "attach one slice per pass: `texture.layer(n)`, in a file `layer: n`; or write it as storage",
                ),
                access if access.is_attachment() || *access == AccessKind::SamePixel => {
                    ("slices", "use layers of a two-dimensional texture")
                }
                _ => ("single slices", "use the whole level"),
            };
        SecondDepth "the pass already has a depth attachment", "split the pass in two";
        SlotTaken { slot: u8 } "color slot {slot} is in use",
            "use `color` (in a file, omit the slot), or choose a free slot";
        NoSuchSlot { slot: u8 } "color slot {slot} does not exist", "use a slot from 0 to 7";
        TooManyColors "a pass has at most 8 color attachments",
            "split the pass, or pack outputs into fewer attachments";
        NothingToResolve "the handle is not a multisampled color or depth attachment of the pass",
            "declare the attachment first, and resolve the handle that it returned (in a file, its slot or \
             `of: Depth`)";
        /// The format does not support the resolve mode.
        ResolveMode { mode: ResolveMode, format: Format } "samples of {format:?} cannot be resolved with mode `{mode}`", "{hint}",
            hint = match format.has_depth() || format.is_color_renderable() {
                true => "use `Sample0`, `Min` or `Max`: depth and integers cannot be averaged",
                false => "resolve a color or depth attachment: stencil cannot be resolved",
            };
        WrongPassKind { kind: PassKind, access: AccessKind } "a {kind} pass cannot use `{access}`",
            "make it a {fits} pass, or split it",
            fits = match access {
                AccessKind::CopySource | AccessKind::CopyTarget => "copy",
                access if access.needs_raster() => "raster",
                _ => "raster or compute",
            };
        MixedKinds { earlier: AccessKind, /** The resource of the earlier access. */ of: String, later: AccessKind }
            "`{later}` cannot share a pass with `{earlier}` of `{of}`", "move the copies to a separate pass";
        /// The texture cannot be forwarded.
        Forward(fault: ForwardReason) => fault.words();
        /// Custom error of the pass.
        Custom { message: String, hint: String } => (message.clone(), hint.clone());
    }
}

/// The user of a stale handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StaleUser {
    /// A pass other than the writer of the newest version.
    OtherPass,
    /// The pass that wrote the newest version.
    SamePass,
    /// A method of the graph, such as an export.
    Graph,
}

/// Returns what to do instead of two conflicting accesses of one pass.
fn instead(earlier: AccessKind, later: AccessKind, buffer: bool) -> &'static str {
    use AccessKind as K;
    let either = |wanted: fn(AccessKind) -> bool| wanted(earlier) || wanted(later);
    if buffer {
        return "write it with `Modify` if the pass reads it too, or split the pass";
    }
    let reads = either(|k| matches!(k, K::Sampled | K::StorageRead | K::SamePixel));
    if reads && either(|k| matches!(k, K::Color | K::Resolve)) {
        "an attached color cannot be read, not even for blending: declare only `Modify` to keep the contents, \
         or read a copy, or other levels or layers"
    } else if reads && either(|k| k == K::Depth) {
        "declare `depth_read_only` instead of `depth` if the pass only tests, or read a copy"
    } else if reads && either(|k| k == K::StorageWrite) {
        "declare only `storage_write` with `Modify` if the pass reads what it writes, or use other levels or layers"
    } else {
        "split the pass, or use different mip levels or layers"
    }
}

/// Returns message and hint for a history image that does not exist.
fn no_history(age: u8, frames: Option<u8>) -> (String, String) {
    let (sentence, hint) = match (age, frames) {
        (_, None) => (
            "the resource is not a history".into(),
            "declare it with `Graph::history`, in a file with `kind: History(frames: 1)`",
        ),
        (0, _) => (
            "age 0 is not an earlier frame of the history".into(),
            "use the history itself: it is the image of this frame",
        ),
        (age, Some(frames)) => {
            (format!("age {age} exceeds the {frames} frames of the history"), "keep more frames, or use a lower age")
        }
    };
    (sentence, hint.into())
}

/// Describes a range.
fn described(range: &Range) -> String {
    let count = |first: u32, count: u32, all: bool| {
        if all { format!("{first}..") } else { format!("{first}..{}", first + count) }
    };
    let mips = count(range.mip.into(), range.mips.into(), range.mips == u8::MAX);
    let layers = count(range.layer.into(), range.layers.into(), range.layers == u16::MAX);
    format!("levels {mips}, layers {layers}, aspect {:?}", range.aspect)
}

impl fmt::Display for DeclareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reason, pass, resource, location } = self;
        show(f, "", (named(pass), named(resource)), reason.words(), Some(location))
    }
}

/// Returns the name of the pass or resource, if any.
pub(crate) fn named<I>(whom: &Option<Named<I>>) -> Option<&str> {
    whom.as_ref().map(|named| named.name.as_str())
}

impl_error!(DeclareError);
