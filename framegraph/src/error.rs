//! What can be wrong with a declaration, said with the names involved, the place in code and what to do about it.

mod forward;

use crate::access::{AccessKind, Range};
use crate::faults::{errors, faults, show};
use crate::format::Format;
use crate::graph::rows::PassKind;
use crate::id::{PassId, ResourceId};
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

faults! {
    /// Why a declaration was refused. `asked` is what the call named, `later` the refused access.
    DeclareReason {
        /// The handle names an older version.
        Stale { writer: String, user: StaleUser }
            "the handle is stale: pass `{writer}` has written a newer version", "use the handle that {use_instead}",
            use_instead = match user {
                StaleUser::OtherPass => format!("`{writer}` returned, or declare this pass before it"),
                StaleUser::SamePass => "the earlier write of this pass returned".into(),
                StaleUser::Graph => format!("`{writer}` returned"),
            };
        Foreign "the handle is of another graph, or from before this graph was reset",
            "declare the resource in this graph, and anew after each reset";
        /// The range lies outside of the texture.
        OutOfRange { asked: Range, texture: TextureDesc }
            "{range} was asked of {mips} levels, {layers} layers, {format:?}",
            "ask for levels, layers and planes that the texture has",
            range = described(asked), TextureDesc { mips, layers, format, .. } = texture;
        /// An earlier image was asked of a resource that keeps none so old.
        NoHistory {
            /// How many frames back, from 1.
            age: u8,
            /// How many earlier frames the history keeps; none for a resource that is no history.
            frames: Option<u8>
        } => no_history(*age, *frames);
        EmptyHistory "a history keeps at least one earlier frame", "give it 1 frame or more";
        HistoryTwice "another history has this name, by which its images are found again in the next frame",
            "name them apart, or declare each in a scope of its own";
        Conflict { earlier: AccessKind, later: AccessKind, /** Of a buffer; otherwise of a texture. */ buffer: bool }
            "`{later}` touches a part that the same pass already uses as `{earlier}`", "{hint}",
            hint = instead(*earlier, *later, *buffer);
        WritesEarlierFrame { access: AccessKind } "`{access}` writes the image that an earlier frame left",
            "write the history itself, which is the image of this frame";
        WrongDirection { access: AccessKind } "`{access}` does not go in that direction",
            "read with an access that reads, write with one that writes";
        Format { format: Format, access: AccessKind } "format {format:?} cannot be used as `{access}`", "{hint}",
            hint = match access {
                AccessKind::StorageRead | AccessKind::StorageWrite if format.is_srgb() => {
                    "use the format without sRGB, and look at it with `viewed_as` where it is sampled"
                }
                _ => "choose a format with that capability",
            };
        Buffer { access: AccessKind } "a buffer cannot be used as `{access}`", "use a texture, or another access";
        Texture { access: AccessKind } "a texture cannot be used as `{access}`", "use a buffer, or another access";
        NoSuchBytes { offset: u64, bytes: u64, /** None where it follows the frame. */ size: Option<u64> }
            "{bytes} bytes from {offset} on were asked of a buffer{of}",
            "ask for one byte or more, all of them inside of the buffer",
            of = size.map(|size| format!(" of {size}")).unwrap_or_default();
        NoTwin { format: Format, view: Format } "a texture of {format:?} cannot be seen as {view:?}",
            "view it in its own format, or in the one that differs in the sRGB transfer function alone";
        NotOneLevel { access: AccessKind } "`{access}` must name one mip level",
            "name the level: `texture.mip(n)`, in a file `mip: n`";
        /// Contents of three-dimensional textures are not followed slice by slice.
        Slices { access: AccessKind } "`{access}` of a level that has several slices",
            "write it as storage or by a copy, or draw into the layers of a two-dimensional texture";
        SecondDepth "a pass has one depth attachment", "split the pass in two";
        SlotTaken { slot: u8 } "color slot {slot} is taken",
            "leave the slot to `color`, in a file leave it out, or name a free one";
        NoSuchSlot { slot: u8 } "there is no color slot {slot}", "name a slot from 0 to 7";
        TooManyColors "a pass has at most 8 color attachments",
            "split the pass, or pack outputs into fewer attachments";
        NothingToResolve "the pass has no multisampled color or depth attachment of that handle",
            "declare the attachment before its resolve, and resolve the handle that it returned, in a file its slot, or \
             `of: Depth`";
        /// Samples of that format cannot be resolved so.
        ResolveMode { mode: ResolveMode, format: Format } "samples of {format:?} cannot be resolved by `{mode}`", "{hint}",
            hint = match format.has_depth() || format.is_color_renderable() {
                true => "resolve it by `Sample0`, `Min` or `Max`: depth and integers have no average",
                false => "resolve a color or depth attachment: stencil stays with its samples",
            };
        WrongPassKind { kind: PassKind, access: AccessKind } "a {kind} pass cannot use `{access}`",
            "make it a {fits} pass, or split it",
            fits = match access {
                AccessKind::CopySource | AccessKind::CopyTarget => "copy",
                access if access.needs_raster() => "raster",
                _ => "raster or compute",
            };
        MixedKinds { earlier: AccessKind, /** The resource of the earlier access. */ of: String, later: AccessKind }
            "`{later}` cannot be in one pass with `{earlier}` of `{of}`", "put the copies into a pass of their own";
        /// A texture cannot be forwarded like that.
        Forward(fault: ForwardFault) => fault.words();
        /// The pass's own reason.
        Custom { message: String, hint: String } => (message.clone(), hint.clone());
    }
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

/// Why there is no image that old, and what to do.
fn no_history(age: u8, frames: Option<u8>) -> (String, String) {
    let (sentence, hint) = match (age, frames) {
        (_, None) => (
            "the resource is not a history".into(),
            "declare it with `Graph::history`, in a file with `kind: History(frames: 1)`",
        ),
        (0, _) => ("frame −0 was asked of a history".into(), "use the history itself: it is the image of this frame"),
        (age, Some(frames)) => (
            format!("frame −{age} was asked of a history of {frames} frames"),
            "give the history as many frames, or ask for a more recent one",
        ),
    };
    (sentence, hint.into())
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

impl fmt::Display for DeclareError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { reason, pass, resource, location } = self;
        show(f, "", (named(pass), named(resource)), reason.words(), Some(location))
    }
}

/// The name of a pass or resource that an error may be about.
pub(crate) fn named<I>(whom: &Option<Named<I>>) -> Option<&str> {
    whom.as_ref().map(|named| named.name.as_str())
}

errors!(DeclareError);
