//! What a pass declares with: one call an access, checked on the spot.

mod accesses;
mod add;
mod admit;
mod buffers;
mod request;

use crate::access::Kinds;
use crate::error::{DeclareError, DeclareReason, Named};
use crate::graph::{Declared, PassFlags, PassKind, Tables};
use crate::handle::{Buffer, Part, ReadOnly, Target, Texture};
use crate::id::{AccessId, PassId, ResourceId, Span};
use crate::resource::{BufferSize, Kind, TextureDesc};
use admit::{barred, inferred_kind, wrong_kind};
use std::panic::Location;

/// The most color attachments that a pass can have on any device.
pub const MAX_COLORS: u8 = 8;

/// Declares the accesses of one pass. Each call checks what it is given and names pass, resource and place when it
/// refuses; a refused pass leaves no trace in the graph.
///
/// ```
/// use framegraph::{ClearValue, DeclareError, Extent, Format, Graph, Intent, TextureDesc};
///
/// let mut graph = Graph::new();
/// let shadow = graph.add_fn("shadow", |pass| {
///     let map = pass.texture("shadow map", TextureDesc::new(Extent::absolute(1024, 1024), Format::Depth32Float));
///     pass.depth(map, Intent::Clear(ClearValue::FAR_REVERSED)) // A write returns the next version of the texture.
/// })?;
/// let (_view, hdr) = graph.add_fn("color", |pass| {
///     let view = pass.sampled(shadow)?; // A read returns a token, by which the recorder gets the view.
///     let hdr = pass.texture("hdr", TextureDesc::new(Extent::FRAME, Format::Rgba16Float));
///     Ok((view, pass.color(hdr, Intent::Overwrite)?))
/// })?;
/// let refused = graph.add_fn("feedback", |pass| {
///     pass.sampled(hdr)?;
///     pass.color(hdr, Intent::Modify)
/// });
/// assert!(refused.is_err_and(|error| error.to_string().starts_with("pass `feedback`: resource `hdr`: ")));
/// assert_eq!(graph.passes().len(), 2);
/// # Ok::<(), DeclareError>(())
/// ```
#[derive(Debug)]
pub struct PassBuilder<'g> {
    tables: &'g mut Tables,
    /// What open scopes put in front of names.
    prefix: &'g str,
    location: &'static Location<'static>,
    name: Span,
    /// Where its accesses and versions begin.
    first: usize,
    first_version: usize,
    pass: PassId,
    /// Its attachment where it has a single one, the color attachment of a texture of one part, and reads nothing at the
    /// same pixel.
    sole: AccessId,
    /// The kinds of its accesses.
    used: Kinds,
    /// The kinds of access that need every check because of what the pass has declared already; the first copy always
    /// does.
    full_check: Kinds,
    /// The color slot behind all that are taken.
    colors: u32,
    flags: PassFlags,
    kind: Option<PassKind>,
}

impl<'g> PassBuilder<'g> {
    #[inline]
    pub(crate) fn new(
        tables: &'g mut Tables,
        prefix: &'g str,
        name: &str,
        location: &'static Location<'static>,
    ) -> Self {
        Self {
            name: tables.push_name(prefix, name),
            first: tables.accesses.len(),
            first_version: tables.versions.len(),
            pass: PassId::at(tables.passes.len()),
            tables,
            prefix,
            location,
            sole: AccessId::NONE,
            used: Kinds::NONE,
            full_check: Kinds::COPIES,
            colors: 0,
            flags: PassFlags::default(),
            kind: None,
        }
    }

    /// Closes the pass: its row, with its kind inferred where none was named.
    ///
    /// # Panics
    /// When a table outgrew what an id can name: then ids that this pass was given are wrong.
    #[inline]
    pub(crate) fn finish(self) {
        let Self { tables, name, first, sole, used, flags, kind, location, .. } = self;
        let (accesses, versions) = (tables.accesses.len(), tables.versions.len());
        assert!(accesses.max(versions) < u32::MAX as usize, "more than 2^32 - 2 elements in one table");
        let accesses = Span::new(first, accesses);
        let kind = kind.unwrap_or_else(|| inferred_kind(used));
        tables.passes.push(Declared { name, accesses, kind, flags, sole_color: sole, location });
    }

    /// Removes the pass and all that it declared.
    pub(crate) fn take_back(self) {
        self.tables.take_pass_back(self.name, self.first, self.first_version);
    }

    /// A transient texture of this pass's making.
    #[inline(always)]
    pub fn texture(&mut self, name: &str, desc: TextureDesc) -> Texture {
        self.tables.texture(self.prefix, name, desc, Kind::Transient)
    }

    /// A transient buffer of this pass's making: of so many bytes, or of a [`BufferSize`] that follows the frame.
    #[inline(always)]
    pub fn buffer(&mut self, name: &str, size: impl Into<BufferSize>) -> Buffer {
        self.tables.buffer(self.prefix, name, size.into(), Kind::Transient)
    }

    /// The given target, or a new transient of that name and shape.
    #[inline]
    pub fn target(&mut self, target: Target, name: &str, desc: TextureDesc) -> Part {
        match target {
            Target::New => self.tables.texture(self.prefix, name, desc, Kind::Transient).into(),
            Target::Into(part) => part,
        }
    }

    /// The shape of a texture.
    ///
    /// # Errors
    /// When the handle is of another graph.
    #[track_caller]
    pub fn desc(&self, texture: impl Into<ReadOnly>) -> Result<TextureDesc, DeclareError> {
        let ReadOnly { tag, version, .. } = texture.into();
        let found =
            self.tables.lookup(tag, version).and_then(|r| self.tables.resources[r.index()].desc.texture().copied());
        found.ok_or_else(|| self.refuse(DeclareReason::Foreign, ResourceId::NONE, Location::caller()))
    }

    /// The pass does something that no resource shows: it is never culled.
    #[inline]
    pub fn side_effect(&mut self) {
        self.flag(PassFlags::SIDE_EFFECT);
    }

    /// Each output texel depends only on the pass's same-pixel inputs there; every texel is covered exactly once.
    #[inline]
    pub fn pointwise(&mut self) {
        self.flag(PassFlags::POINTWISE);
    }

    /// The pass blends into its color attachments.
    #[inline]
    pub fn blends(&mut self) {
        self.flag(PassFlags::BLENDS);
    }

    /// The pass's shader can take a point-wise epilogue.
    #[inline]
    pub fn takes_epilogue(&mut self) {
        self.flag(PassFlags::TAKES_EPILOGUE);
    }

    /// The pass must stay a step of its own.
    #[inline]
    pub fn never_merge(&mut self) {
        self.flag(PassFlags::NEVER_MERGE);
    }

    /// The pass must run on the first queue, whatever others a device has (`framegraph-queues`).
    #[inline]
    pub fn main_queue(&mut self) {
        self.flag(PassFlags::MAIN_QUEUE);
    }

    /// Names the kind of the pass, instead of leaving it to its accesses (attachments, same-pixel reads, vertices and
    /// indices make a raster pass, nothing but copies a copy, all else is compute).
    ///
    /// # Errors
    /// When an access made so far needs another kind.
    #[track_caller]
    pub fn kind(&mut self, kind: PassKind) -> Result<(), DeclareError> {
        for access in &self.tables.accesses[self.first..] {
            if let Some(reason) = wrong_kind(kind, access.kind) {
                return Err(self.refuse(reason, access.resource, Location::caller()));
            }
        }
        self.kind = Some(kind);
        self.full_check = self.full_check.union(barred(kind));
        Ok(())
    }

    /// The kind that the pass has as long as none is named.
    #[cfg(feature = "files")]
    pub(crate) const fn inferred(&self) -> PassKind {
        inferred_kind(self.used)
    }

    /// An error of the pass's own, with the pass's name and the caller's place.
    #[track_caller]
    pub fn error(&self, message: impl Into<String>, hint: impl Into<String>) -> DeclareError {
        let reason = DeclareReason::Custom { message: message.into(), hint: hint.into() };
        self.refuse(reason, ResourceId::NONE, Location::caller())
    }

    #[inline]
    fn flag(&mut self, flag: PassFlags) {
        self.flags.set(flag);
    }

    /// The name of this pass.
    fn own_name(&self) -> &str {
        &self.tables.names[self.name.range()]
    }

    #[cold]
    #[inline(never)]
    fn refuse(
        &self,
        reason: DeclareReason,
        resource: ResourceId,
        location: &'static Location<'static>,
    ) -> DeclareError {
        let pass = Some(Named { id: self.pass, name: self.own_name().to_owned() });
        DeclareError { reason, pass, resource: self.tables.named_resource(resource), location }
    }
}
