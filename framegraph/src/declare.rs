//! Declaring: the trait that passes implement, and the calls on the graph itself.
//!
//! `trait Pass` is the face, flat arrays are the bone: a pass keeps the handles it reads as typed fields, declares once
//! and returns the handles it wrote; what it declares goes into the arrays of [`Graph`], and only those arrays reach the
//! compiler.

mod forward;
mod mark;

use crate::access::Kinds;
use crate::error::{DeclareError, DeclareReason, Named, StaleUser};
use crate::graph::rows::Note;
use crate::graph::{Export, ExportKind, Graph, Tables, Version};
use crate::handle::{Buffer, Previous, Tag, Texture};
use crate::id::{AccessId, PassId, ResourceId, Span, VersionId};
use crate::pass_builder::PassBuilder;
use crate::resource::{BufferDesc, BufferSize, Desc, Entry, Exit, Kind, Resource, TextureDesc};
use std::fmt::{Display, Write};
use std::panic::Location;

/// A unit of work, as the graph sees it: what it reads, what it writes and why.
///
/// ```
/// use framegraph::{ClearValue, DeclareError, Extent, Format, Graph, Intent, Pass, PassBuilder, Texture, TextureDesc};
///
/// struct Sky;
///
/// impl Pass for Sky {
///     type Io = Texture;
///     fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
///         let sky = pass.texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
///         pass.color(sky, Intent::Clear(ClearValue::BLACK))
///     }
/// }
///
/// let mut graph = Graph::new();
/// let sky = graph.add("sky", &Sky)?;
/// graph.export(sky)?;
/// # Ok::<(), DeclareError>(())
/// ```
pub trait Pass {
    /// The handles and tokens this pass works with: what others read, and what its recorder looks up.
    type Io: Clone;

    /// Declares every access of the pass.
    ///
    /// # Errors
    /// Whatever the builder's calls refuse, or a reason of the pass's own ([`PassBuilder::error`]).
    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Self::Io, DeclareError>;
}

impl Graph {
    /// Declares a pass and returns what it gave back.
    ///
    /// # Errors
    /// What the pass's declaration returned; nothing of the pass stays in the graph then.
    #[track_caller]
    pub fn add<P: Pass + ?Sized>(&mut self, name: &str, pass: &P) -> Result<P::Io, DeclareError> {
        self.add_at(name, Location::caller(), |p| pass.declare(p))
    }

    /// Declares a one-off pass with a closure.
    ///
    /// # Errors
    /// What the closure returned; nothing of the pass stays in the graph then.
    #[track_caller]
    pub fn add_fn<T>(
        &mut self,
        name: &str,
        declare: impl FnOnce(&mut PassBuilder<'_>) -> Result<T, DeclareError>,
    ) -> Result<T, DeclareError> {
        self.add_at(name, Location::caller(), declare)
    }

    fn add_at<T>(
        &mut self,
        name: &str,
        location: &'static Location<'static>,
        declare: impl FnOnce(&mut PassBuilder<'_>) -> Result<T, DeclareError>,
    ) -> Result<T, DeclareError> {
        let (tables, prefix) = self.open();
        let mut pass = PassBuilder::new(tables, prefix, name, location);
        match declare(&mut pass) {
            Ok(io) => {
                pass.finish();
                Ok(io)
            }
            Err(error) => {
                pass.take_back();
                Err(error)
            }
        }
    }

    /// Runs `body` with `name/` in front of every name declared in it; effects of several passes nest this way.
    pub fn scope<T>(&mut self, name: &str, body: impl FnOnce(&mut Self) -> T) -> T {
        let length = self.prefix.len();
        self.prefix.push_str(name);
        self.prefix.push('/');
        let out = body(self);
        self.prefix.truncate(length);
        out
    }

    /// Notes why an effect of several passes is in the frame, or is not: what no access tells. It changes nothing, and stands
    /// before the decisions of plans that are made of the graph. `about` gets the names of open scopes before it, as passes do.
    pub fn note(&mut self, about: &str, text: impl Display) {
        let (tables, prefix) = self.open();
        let about = tables.push_name(prefix, about);
        let start = tables.names.len();
        write!(tables.names, "{text}").expect("strings take every text");
        tables.notes.push(Note { about, text: Span::new(start, tables.names.len()) });
    }

    /// A transient texture: nothing is in it until a pass writes it.
    pub fn texture(&mut self, name: &str, desc: TextureDesc) -> Texture {
        let (tables, prefix) = self.open();
        tables.texture(prefix, name, desc, Kind::Transient)
    }

    /// A transient buffer: of so many bytes, or of a [`BufferSize`] that follows the frame.
    pub fn buffer(&mut self, name: &str, size: impl Into<BufferSize>) -> Buffer {
        let (tables, prefix) = self.open();
        tables.buffer(prefix, name, size.into(), Kind::Transient)
    }

    /// A texture that the caller owns: what it holds on entry and whether it must survive.
    pub fn import_texture(&mut self, name: &str, desc: TextureDesc, entry: Entry, exit: Exit) -> Texture {
        let (tables, prefix) = self.open();
        tables.texture(prefix, name, desc, Kind::Imported { entry, exit })
    }

    /// A buffer that the caller owns, of so many bytes, or of a [`BufferSize`] that follows the frame.
    pub fn import_buffer(&mut self, name: &str, size: impl Into<BufferSize>, entry: Entry, exit: Exit) -> Buffer {
        let (tables, prefix) = self.open();
        tables.buffer(prefix, name, size.into(), Kind::Imported { entry, exit })
    }

    /// A texture whose last `frames` versions stay readable in later frames: the image that this frame writes.
    ///
    /// The ring has `frames + 1` images. On the first frame, and after a reset of the history, the earlier images hold
    /// zeros and the back end says that they are not valid. A back end knows a history from frame to frame by who declares it
    /// (of `framegraph_wgpu` the `Frame`, not the executor) and its full name, so a graph has one history of a name; scopes
    /// tell two views apart.
    #[track_caller]
    pub fn history(&mut self, name: &str, desc: TextureDesc, frames: u8) -> Texture {
        if frames == 0 {
            let resource = Named { id: ResourceId::at(self.resources.len()), name: name.to_owned() };
            let (reason, location) = (DeclareReason::EmptyHistory, Location::caller());
            self.open().0.errors.push(DeclareError { reason, pass: None, resource: Some(resource), location });
        }
        let (tables, prefix) = self.open();
        let history = tables.texture(prefix, name, desc, Kind::HistoryCurrent { frames });
        let (own, earlier) = tables.resources.split_last().expect("it was just declared");
        let namesake = |r: &Resource| {
            matches!(r.kind, Kind::HistoryCurrent { .. })
                && tables.names[r.name.range()] == tables.names[own.name.range()]
        };
        if earlier.iter().any(namesake) {
            let own = tables.named_resource(ResourceId::at(earlier.len()));
            let (reason, location) = (DeclareReason::HistoryTwice, Location::caller());
            tables.errors.push(DeclareError { reason, pass: None, resource: own, location });
        }
        history
    }

    /// The image of a history as it was `age` frames ago, `age` from 1 to the history's `frames`. Any handle of the
    /// history names it, also a stale one.
    ///
    /// # Errors
    /// When the handle is not of a history, or the history is shorter.
    #[track_caller]
    pub fn previous(&mut self, history: Texture, age: u8) -> Result<Previous, DeclareError> {
        let location = Location::caller();
        let fail = |reason, resource| DeclareError { reason, pass: None, resource, location };
        let Some(current) = self.lookup(history.tag, history.version) else {
            return Err(fail(DeclareReason::Foreign, None));
        };
        let Resource { kind, desc, .. } = self.resources[current.index()];
        let frames = match kind {
            Kind::HistoryCurrent { frames } => Some(frames),
            _ => None,
        };
        if !frames.is_some_and(|frames| (1..=frames).contains(&age)) {
            let resource = self.named_resource(current);
            return Err(fail(DeclareReason::NoHistory { age, frames }, resource));
        }
        let kind = Kind::HistoryPrevious { current, age };
        let known = self.resources.iter().position(|r| r.kind == kind);
        let version = match known {
            Some(index) => self.resources[index].current,
            None => {
                let (tables, _) = self.open();
                let span = tables.resources[current.index()].name;
                let start = tables.names.len();
                tables.names.extend_from_within(span.range());
                tables.names.push_str("@-");
                tables.names.push_str(&age.to_string());
                tables.push_row(Span::new(start, tables.names.len()), desc, kind)
            }
        };
        Ok(Previous { tag: self.tag, version })
    }

    /// Says what the frame is for: `texture` must exist when it ends. The root of culling.
    ///
    /// # Errors
    /// A handle of another graph, or one that a pass has written a newer version of.
    #[track_caller]
    pub fn export(&mut self, texture: Texture) -> Result<(), DeclareError> {
        self.open().0.push_export(texture.tag, texture.version, ExportKind::Keep, Location::caller())
    }

    /// As [`Graph::export`], for contents that the CPU will read.
    ///
    /// # Errors
    /// As [`Graph::export`].
    #[track_caller]
    pub fn readback(&mut self, texture: Texture) -> Result<(), DeclareError> {
        self.open().0.push_export(texture.tag, texture.version, ExportKind::Readback, Location::caller())
    }

    /// As [`Graph::export`], for a buffer.
    ///
    /// # Errors
    /// As [`Graph::export`].
    #[track_caller]
    pub fn export_buffer(&mut self, buffer: Buffer) -> Result<(), DeclareError> {
        self.open().0.push_export(buffer.tag, buffer.version, ExportKind::Keep, Location::caller())
    }

    /// As [`Graph::readback`], for a buffer.
    ///
    /// # Errors
    /// As [`Graph::export`].
    #[track_caller]
    pub fn readback_buffer(&mut self, buffer: Buffer) -> Result<(), DeclareError> {
        self.open().0.push_export(buffer.tag, buffer.version, ExportKind::Readback, Location::caller())
    }

    /// The shape of a texture; `None` for a handle of another graph.
    pub fn desc(&self, texture: Texture) -> Option<TextureDesc> {
        let resource = self.lookup(texture.tag, texture.version)?;
        self.resources[resource.index()].desc.texture().copied()
    }

    /// The resource that a texture handle names; `None` for a handle of another graph.
    pub fn resource_of(&self, texture: Texture) -> Option<ResourceId> {
        self.lookup(texture.tag, texture.version)
    }

    /// The resource that a buffer handle names; `None` for a handle of another graph.
    pub fn resource_of_buffer(&self, buffer: Buffer) -> Option<ResourceId> {
        self.lookup(buffer.tag, buffer.version)
    }
}

impl Tables {
    /// A texture with its name, its row and the version that it holds on entry.
    #[inline]
    pub(crate) fn texture(&mut self, prefix: &str, name: &str, desc: TextureDesc, kind: Kind) -> Texture {
        let name = self.push_name(prefix, name);
        let version = self.push_row(name, Desc::Texture(desc), kind);
        Texture { tag: self.tag, version }
    }

    /// As [`Tables::texture`], for a buffer.
    #[inline]
    pub(crate) fn buffer(&mut self, prefix: &str, name: &str, size: BufferSize, kind: Kind) -> Buffer {
        let name = self.push_name(prefix, name);
        let version = self.push_row(name, Desc::Buffer(BufferDesc { size }), kind);
        Buffer { tag: self.tag, version }
    }

    fn push_export(
        &mut self,
        tag: Tag,
        version: VersionId,
        kind: ExportKind,
        location: &'static Location<'static>,
    ) -> Result<(), DeclareError> {
        let refused = |reason, resource| Err(DeclareError { reason, pass: None, resource, location });
        let Some(resource) = self.lookup(tag, version) else {
            return refused(DeclareReason::Foreign, None);
        };
        let current = self.resources[resource.index()].current;
        if current != version {
            let writer = self.writer_name(current).to_owned();
            let reason = DeclareReason::Stale { writer, user: StaleUser::Graph };
            return refused(reason, self.named_resource(resource));
        }
        self.contents_uncertain |= self.versions[version.index()].writer.is_none();
        self.exports.push(Export { resource, version, kind });
        Ok(())
    }

    /// The name of the pass that wrote a version. There is none when its declaration panicked and that was caught.
    pub(crate) fn writer_name(&self, version: VersionId) -> &str {
        let Some(row) = self.versions.get(version.index()) else {
            return "(what forwarded it)";
        };
        self.passes.get(row.writer.index()).map_or("(a pass that panicked)", |row| &self.names[row.name.range()])
    }

    #[inline]
    pub(crate) fn push_name(&mut self, prefix: &str, name: &str) -> Span {
        let start = self.names.len();
        if !prefix.is_empty() {
            self.names.push_str(prefix);
        }
        self.names.push_str(name);
        Span::new(start, self.names.len())
    }

    #[inline(always)]
    fn push_row(&mut self, name: Span, desc: Desc, kind: Kind) -> VersionId {
        // There are no more resources than versions.
        let current = VersionId::at(self.versions.len());
        let resource = ResourceId::unchecked(self.resources.len());
        self.versions.push(Version {
            resource,
            writer: PassId::NONE,
            access: AccessId::NONE,
            previous: VersionId::NONE,
            reader: PassId::NONE,
            open: Kinds::on_entry(&desc, kind),
        });
        self.resources.push(Resource { name, current, kind, desc });
        current
    }
}
