//! The builder that a pass uses to declare its accesses.

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

/// Maximum number of color attachments of a pass, on any device.
pub const MAX_COLORS: u8 = 8;

/// Declares the accesses of one pass.
///
/// Every method checks its arguments. Errors name the pass, the resource and the source location. A rejected pass
/// leaves no trace in the graph.
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
    /// Prefix that the open scopes add to names.
    prefix: &'g str,
    location: &'static Location<'static>,
    name: Span,
    /// Index of the pass's first access; `first_version` is that of its first version.
    first: usize,
    first_version: usize,
    pass: PassId,
    /// The pass's only attachment, if it is a color attachment with one subresource and the pass reads nothing at the
    /// same pixel.
    sole: AccessId,
    /// Access kinds used so far.
    used: Kinds,
    /// Access kinds that need the full check because of earlier accesses of the pass. The first copy always needs it.
    full_check: Kinds,
    /// The color slot after the highest one in use.
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

    /// Adds the row of the pass. Infers its kind from its accesses if none was set.
    ///
    /// # Panics
    /// Panics if a table has grown beyond `u32::MAX` rows, because ids would be ambiguous.
    #[inline]
    pub(crate) fn finish(self) {
        let Self { tables, name, first, sole, used, mut flags, kind, location, .. } = self;
        let (accesses, versions) = (tables.accesses.len(), tables.versions.len());
        assert!(accesses.max(versions) < u32::MAX as usize, "more than 2^32 - 2 elements in one table");
        let accesses = Span::new(first, accesses);
        let kind = kind.unwrap_or_else(|| inferred_kind(used));
        if tables.accesses_alias(accesses) {
            flags.alias();
        }
        tables.passes.push(Declared { name, accesses, kind, flags, sole_color: sole, location });
    }

    /// Removes the pass and everything it declared.
    pub(crate) fn take_back(self) {
        self.tables.take_pass_back(self.name, self.first, self.first_version);
    }

    /// Creates a transient texture.
    #[inline(always)]
    pub fn texture(&mut self, name: &str, desc: TextureDesc) -> Texture {
        self.tables.texture(self.prefix, name, desc, Kind::Transient)
    }

    /// Creates a transient buffer, with a fixed size in bytes or a [`BufferSize`] relative to the frame.
    #[inline(always)]
    pub fn buffer(&mut self, name: &str, size: impl Into<BufferSize>) -> Buffer {
        self.tables.buffer(self.prefix, name, size.into(), Kind::Transient)
    }

    /// Returns the given target, or creates a transient texture with this name and descriptor.
    #[inline]
    pub fn target(&mut self, target: Target, name: &str, desc: TextureDesc) -> Part {
        match target {
            Target::New => self.tables.texture(self.prefix, name, desc, Kind::Transient).into(),
            Target::Into(part) => part,
        }
    }

    /// Returns the descriptor of a texture.
    ///
    /// # Errors
    /// Returns an error if the handle belongs to another graph.
    #[track_caller]
    pub fn desc(&self, texture: impl Into<ReadOnly>) -> Result<TextureDesc, DeclareError> {
        let ReadOnly { tag, version, .. } = texture.into();
        let found =
            self.tables.lookup(tag, version).and_then(|r| self.tables.resources[r.index()].desc.texture().copied());
        found.ok_or_else(|| self.refuse(DeclareReason::Foreign, ResourceId::NONE, Location::caller()))
    }

    /// Marks the pass as having an effect outside of its declared resources. It is never culled.
    #[inline]
    pub fn side_effect(&mut self) {
        self.flag(PassFlags::SIDE_EFFECT);
    }

    /// Marks the pass as point-wise: each output texel depends only on the same-pixel inputs at that texel, and every
    /// texel is covered exactly once.
    #[inline]
    pub fn pointwise(&mut self) {
        self.flag(PassFlags::POINTWISE);
    }

    /// Marks the pass as blending into its color attachments.
    #[inline]
    pub fn blends(&mut self) {
        self.flag(PassFlags::BLENDS);
    }

    /// Marks the pass's shader as accepting a point-wise epilogue.
    #[inline]
    pub fn takes_epilogue(&mut self) {
        self.flag(PassFlags::TAKES_EPILOGUE);
    }

    /// Prevents merging: the pass stays a step of its own.
    #[inline]
    pub fn never_merge(&mut self) {
        self.flag(PassFlags::NEVER_MERGE);
    }

    /// Pins the pass to the first queue of a device with several queues (`framegraph-queues`).
    #[inline]
    pub fn main_queue(&mut self) {
        self.flag(PassFlags::MAIN_QUEUE);
    }

    /// Sets the kind of the pass.
    ///
    /// By default the kind is inferred from the accesses. Attachments, same-pixel reads, vertex and index buffers imply
    /// raster; copies imply copy; everything else is compute.
    ///
    /// # Errors
    /// Returns an error if an earlier access requires another kind.
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

    /// Returns the kind inferred from the accesses so far.
    #[cfg(feature = "files")]
    pub(crate) const fn inferred(&self) -> PassKind {
        inferred_kind(self.used)
    }

    /// Creates a custom error that carries the pass's name and the caller's source location.
    #[track_caller]
    pub fn error(&self, message: impl Into<String>, hint: impl Into<String>) -> DeclareError {
        let reason = DeclareReason::Custom { message: message.into(), hint: hint.into() };
        self.refuse(reason, ResourceId::NONE, Location::caller())
    }

    #[inline]
    fn flag(&mut self, flag: PassFlags) {
        self.flags.set(flag);
    }

    /// Returns the name of this pass.
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
