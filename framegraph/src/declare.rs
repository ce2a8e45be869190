//! Declaring: the [`Pass`] trait, and the methods of [`Graph`] that add passes and resources.
//!
//! A pass keeps the handles it reads as typed fields, declares its accesses once and returns the handles it wrote. The
//! declarations are stored in the arrays of [`Graph`]; the compiler sees only those.

mod alias;
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

/// A unit of work that declares its reads and writes.
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
    /// Handles and tokens of this pass: its outputs for other passes, and the views its recorder looks up.
    type Io: Clone;

    /// Declares every access of the pass.
    ///
    /// # Errors
    /// Returns the errors of the builder's methods, or a custom error ([`PassBuilder::error`]).
    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Self::Io, DeclareError>;
}

impl Graph {
    /// Adds a pass and returns the value that its declaration returned.
    ///
    /// # Errors
    /// Returns the error of the pass's declaration. The graph then contains nothing of the pass.
    #[track_caller]
    pub fn add<P: Pass + ?Sized>(&mut self, name: &str, pass: &P) -> Result<P::Io, DeclareError> {
        self.add_at(name, Location::caller(), |p| pass.declare(p))
    }

    /// Adds a pass that is declared by a closure.
    ///
    /// # Errors
    /// Returns the error of the closure. The graph then contains nothing of the pass.
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
        let (tables, prefix) = self.tables_mut();
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

    /// Runs `body` in a scope: every name declared in it gets the prefix `name/`. Scopes nest.
    pub fn scope<T>(&mut self, name: &str, body: impl FnOnce(&mut Self) -> T) -> T {
        let length = self.prefix.len();
        self.prefix.push_str(name);
        self.prefix.push('/');
        let out = body(self);
        self.prefix.truncate(length);
        out
    }

    /// Adds a note, for example the reason why an effect is or is not part of the frame.
    ///
    /// Notes do not influence compilation. Dumps of a plan show them before its decisions. `about` gets the prefix of
    /// the open scopes, like the name of a pass.
    pub fn note(&mut self, about: &str, text: impl Display) {
        let (tables, prefix) = self.tables_mut();
        let about = tables.push_name(prefix, about);
        let start = tables.names.len();
        write!(tables.names, "{text}").expect("writing to a string cannot fail");
        tables.notes.push(Note { about, text: Span::new(start, tables.names.len()) });
    }

    /// Creates a transient texture. Its contents are undefined until a pass writes it.
    pub fn texture(&mut self, name: &str, desc: TextureDesc) -> Texture {
        let (tables, prefix) = self.tables_mut();
        tables.texture(prefix, name, desc, Kind::Transient)
    }

    /// Creates a transient buffer, with a fixed size in bytes or a [`BufferSize`] relative to the frame.
    pub fn buffer(&mut self, name: &str, size: impl Into<BufferSize>) -> Buffer {
        let (tables, prefix) = self.tables_mut();
        tables.buffer(prefix, name, size.into(), Kind::Transient)
    }

    /// Imports a texture that the caller owns.
    ///
    /// `entry` describes its contents at the start of the frame. `exit` says if its contents must survive the frame.
    pub fn import_texture(&mut self, name: &str, desc: TextureDesc, entry: Entry, exit: Exit) -> Texture {
        let (tables, prefix) = self.tables_mut();
        tables.texture(prefix, name, desc, Kind::Imported { entry, exit })
    }

    /// Imports a buffer that the caller owns, with a fixed size in bytes or a [`BufferSize`] relative to the frame.
    pub fn import_buffer(&mut self, name: &str, size: impl Into<BufferSize>, entry: Entry, exit: Exit) -> Buffer {
        let (tables, prefix) = self.tables_mut();
        tables.buffer(prefix, name, size.into(), Kind::Imported { entry, exit })
    }

    /// Creates a texture whose last `frames` versions stay readable in later frames. Returns the image that this frame
    /// writes.
    ///
    /// The back end keeps a ring of `frames + 1` images. On the first frame, and after a reset of the history, the
    /// earlier images hold zeros and are reported as invalid.
    ///
    /// The back end identifies a history by its full name and by the graph's owner (in `framegraph_wgpu` the `Frame`,
    /// not the executor). A graph must therefore not contain two histories of the same name; use scopes to separate
    /// views.
    #[track_caller]
    pub fn history(&mut self, name: &str, desc: TextureDesc, frames: u8) -> Texture {
        if frames == 0 {
            let resource = Named { id: ResourceId::at(self.resources.len()), name: name.to_owned() };
            let (reason, location) = (DeclareReason::EmptyHistory, Location::caller());
            self.tables_mut().0.errors.push(DeclareError { reason, pass: None, resource: Some(resource), location });
        }
        let (tables, prefix) = self.tables_mut();
        let history = tables.texture(prefix, name, desc, Kind::HistoryCurrent { frames });
        let (own, earlier) = tables.resources.split_last().expect("the history was just added");
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

    /// Returns the image of a history as it was `age` frames ago; `age` ranges from 1 to the history's `frames`.
    /// Accepts any handle of the history, even a stale one.
    ///
    /// # Errors
    /// Returns an error if the handle is not that of a history, or `age` is out of range.
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
                let (tables, _) = self.tables_mut();
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

    /// Exports a texture: its contents must exist when the frame ends. Exports keep the passes they depend on from
    /// being culled.
    ///
    /// # Errors
    /// Returns an error if the handle belongs to another graph or is stale.
    #[track_caller]
    pub fn export(&mut self, texture: Texture) -> Result<(), DeclareError> {
        self.tables_mut().0.push_export(texture.tag, texture.version, ExportKind::Keep, Location::caller())
    }

    /// Exports a texture that the CPU reads after the frame.
    ///
    /// # Errors
    /// Returns the errors of [`Graph::export`].
    #[track_caller]
    pub fn readback(&mut self, texture: Texture) -> Result<(), DeclareError> {
        self.tables_mut().0.push_export(texture.tag, texture.version, ExportKind::Readback, Location::caller())
    }

    /// Exports a buffer: its contents must exist when the frame ends.
    ///
    /// # Errors
    /// Returns the errors of [`Graph::export`].
    #[track_caller]
    pub fn export_buffer(&mut self, buffer: Buffer) -> Result<(), DeclareError> {
        self.tables_mut().0.push_export(buffer.tag, buffer.version, ExportKind::Keep, Location::caller())
    }

    /// Exports a buffer that the CPU reads after the frame.
    ///
    /// # Errors
    /// Returns the errors of [`Graph::export`].
    #[track_caller]
    pub fn readback_buffer(&mut self, buffer: Buffer) -> Result<(), DeclareError> {
        self.tables_mut().0.push_export(buffer.tag, buffer.version, ExportKind::Readback, Location::caller())
    }

    /// Returns the descriptor of a texture; `None` if the handle belongs to another graph.
    pub fn desc(&self, texture: Texture) -> Option<TextureDesc> {
        let resource = self.lookup(texture.tag, texture.version)?;
        self.resources[resource.index()].desc.texture().copied()
    }

    /// Returns the resource of a texture handle; `None` if the handle belongs to another graph.
    pub fn resource_of(&self, texture: Texture) -> Option<ResourceId> {
        self.lookup(texture.tag, texture.version)
    }

    /// Returns the resource of a buffer handle; `None` if the handle belongs to another graph.
    pub fn resource_of_buffer(&self, buffer: Buffer) -> Option<ResourceId> {
        self.lookup(buffer.tag, buffer.version)
    }
}

impl Tables {
    /// Adds a texture: its name, its row and its initial version.
    #[inline]
    pub(crate) fn texture(&mut self, prefix: &str, name: &str, desc: TextureDesc, kind: Kind) -> Texture {
        let name = self.push_name(prefix, name);
        let version = self.push_row(name, Desc::Texture(desc), kind);
        Texture { tag: self.tag, version }
    }

    /// Adds a buffer: its name, its row and its initial version.
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

    /// Returns the name of the pass that wrote a version. A placeholder if a panic interrupted its declaration.
    pub(crate) fn writer_name(&self, version: VersionId) -> &str {
        let Some(row) = self.versions.get(version.index()) else {
            return "(the forward)";
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
        // Cannot overflow: there are at most as many resources as versions.
        let current = VersionId::at(self.versions.len());
        let resource = ResourceId::unchecked(self.resources.len());
        self.versions.push(Version {
            resource,
            writer: PassId::NONE,
            access: AccessId::NONE,
            previous: VersionId::NONE,
            reader: PassId::NONE,
            allowed: Kinds::on_entry(&desc, kind),
        });
        self.resources.push(Resource { name, current, kind, desc });
        current
    }
}
