//! What a pass declares with: one call an access, checked on the spot.

mod accesses;
mod admit;

use crate::access::{Access, AccessKind, Mode, Range};
use crate::error::{DeclareError, DeclareReason};
use crate::graph::{PassFlags, PassKind, Tables, Version};
use crate::handle::{Buffer, Part, ReadOnly, Tag, Target, Texture};
use crate::id::{AccessId, PassId, ResourceId, Span, VersionId};
use crate::resource::{Kind, TextureDesc};
pub(crate) use admit::plain_kinds;
use admit::{ATTACHMENTS, COPIES, DEPTHS, ONE_PART, READS, conflicts, incapable, inferred_kind, mixed, wrong_kind};
use std::panic::Location;

/// The most color attachments that a pass can have on any device.
pub const MAX_COLORS: u8 = 8;

/// Declares the accesses of one pass. Each call checks what it is given and names pass, resource and place when it
/// refuses; a refused pass leaves no trace in the graph.
#[derive(Debug)]
pub struct PassBuilder<'g> {
    tables: &'g mut Tables,
    /// What open scopes put in front of names.
    prefix: &'g str,
    pass: PassId,
    /// Where its accesses begin.
    first: usize,
    /// The color slots that are taken, and the next one.
    slots: u8,
    colors: u8,
    /// The kinds of its accesses, a bit each.
    used: u16,
    /// The kinds of access that need a closer look because of what the pass has declared already; copies always do.
    doubtful: u16,
    /// Its last color attachment, where that is of a texture of one part.
    color: AccessId,
    kind: Option<PassKind>,
}

/// One access that is about to be checked and added.
#[derive(Clone, Copy)]
struct Request {
    tag: Tag,
    version: VersionId,
    range: Range,
    kind: AccessKind,
    mode: Mode,
    slot: u8,
    clear: u32,
}

impl<'g> PassBuilder<'g> {
    pub(crate) fn new(tables: &'g mut Tables, prefix: &'g str, pass: PassId) -> Self {
        Self {
            first: tables.accesses.len(),
            tables,
            prefix,
            pass,
            slots: 0,
            colors: 0,
            used: 0,
            doubtful: COPIES,
            color: AccessId::NONE,
            kind: None,
        }
    }

    /// Closes the pass: its span of accesses, and its kind where none was named.
    #[inline]
    pub(crate) fn finish(self) {
        let row = &mut self.tables.passes[self.pass.index()];
        row.accesses = Span::new(self.first, self.tables.accesses.len());
        row.kind = self.kind.unwrap_or_else(|| inferred_kind(self.used));
        let watched = ATTACHMENTS | AccessKind::SamePixel.bit();
        let single = self.used & watched == AccessKind::Color.bit() && self.slots.is_power_of_two();
        let sole = if single { self.color } else { AccessId::NONE };
        self.tables.sole_colors.push(sole);
    }

    /// A transient texture of this pass's making.
    pub fn texture(&mut self, name: &str, desc: TextureDesc) -> Texture {
        self.tables.texture(self.prefix, name, desc, Kind::Transient)
    }

    /// A transient buffer of this pass's making, in bytes.
    pub fn buffer(&mut self, name: &str, bytes: u64) -> Buffer {
        self.tables.buffer(self.prefix, name, bytes, Kind::Transient)
    }

    /// The given target, or a new transient of that name and shape.
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
    pub fn side_effect(&mut self) {
        self.flag(PassFlags::SIDE_EFFECT);
    }

    /// Each output texel depends only on the pass's same-pixel inputs there; every texel is covered exactly once.
    pub fn pointwise(&mut self) {
        self.flag(PassFlags::POINTWISE);
    }

    /// The pass blends into its color attachments.
    pub fn blends(&mut self) {
        self.flag(PassFlags::BLENDS);
    }

    /// The pass's shader can take a point-wise epilogue.
    pub fn takes_epilogue(&mut self) {
        self.flag(PassFlags::TAKES_EPILOGUE);
    }

    /// The pass must stay a step of its own.
    pub fn never_merge(&mut self) {
        self.flag(PassFlags::NEVER_MERGE);
    }

    /// Names the kind of the pass, instead of leaving it to its accesses (attachments, same-pixel reads, vertices and
    /// indices make a raster pass, nothing but copies a copy, all else is compute).
    ///
    /// # Errors
    /// When an access made so far needs another kind.
    #[track_caller]
    pub fn kind(&mut self, kind: PassKind) -> Result<(), DeclareError> {
        for access in self.own() {
            if let Some(reason) = wrong_kind(kind, access.kind) {
                return Err(self.refuse(reason, access.resource, Location::caller()));
            }
        }
        self.kind = Some(kind);
        self.doubtful = u16::MAX;
        Ok(())
    }

    /// The kind that the pass has as long as none is named.
    pub(crate) const fn inferred(&self) -> PassKind {
        inferred_kind(self.used)
    }

    /// An error of the pass's own, with the pass's name and the caller's place.
    #[track_caller]
    pub fn error(&self, message: impl Into<String>, hint: impl Into<String>) -> DeclareError {
        let reason = DeclareReason::Custom { message: message.into(), hint: hint.into() };
        self.refuse(reason, ResourceId::NONE, Location::caller())
    }

    /// Checks an access in full and adds it; a write also gets its new version.
    #[inline(never)]
    fn push(
        &mut self,
        r: &Request,
        location: &'static Location<'static>,
    ) -> Result<(AccessId, VersionId), DeclareError> {
        let Some(resource) = self.tables.lookup(r.tag, r.version) else {
            return Err(self.refuse(DeclareReason::Foreign, ResourceId::NONE, location));
        };
        if let Some(reason) = self.objection(resource, r) {
            return Err(self.refuse(reason, resource, location));
        }
        let unwritten = self.tables.versions[r.version.index()].writer.is_none();
        self.tables.doubts |= !r.range.is_all() || (unwritten && r.mode.needs_contents());
        let range = match self.tables.resources[resource.index()].desc.texture() {
            Some(texture) if !r.range.is_all() => r.range.canonical(texture),
            _ => r.range,
        };
        if COPIES & r.kind.bit() != 0 {
            self.doubtful = u16::MAX;
        }
        Ok(self.add(resource, &Request { range, ..*r }))
    }

    /// The resource of an access to the whole of it that nothing can stand against, by a test that most accesses pass; the
    /// others are judged by `push`.
    #[inline(always)]
    fn plain(&self, tag: Tag, version: VersionId, kind: AccessKind, mode: Mode) -> Option<ResourceId> {
        let row = self.tables.versions.get(version.index())?;
        let at = row.resource.index();
        let newest = tag == self.tables.tag && self.tables.resources[at].current == version;
        let allowed = self.tables.plain_kinds[at] & !self.doubtful & kind.bit() != 0;
        // What the pass wrote itself, or for a write also what it reads, would be a conflict.
        let apart = if READS & kind.bit() != 0 {
            row.writer != self.pass
        } else {
            self.own().iter().all(|a| a.resource != row.resource)
        };
        let written = !mode.needs_contents() || !row.writer.is_none();
        (newest && allowed && apart && written).then_some(row.resource)
    }

    /// Adds an access that was checked.
    #[inline(always)]
    fn add(&mut self, resource: ResourceId, r: &Request) -> (AccessId, VersionId) {
        self.used |= r.kind.bit();
        if r.kind.is_depth() {
            self.doubtful |= DEPTHS;
        }
        let access = AccessId::at(self.tables.accesses.len());
        let mut version = r.version;
        if r.mode.writes() {
            version = VersionId::at(self.tables.versions.len());
            self.tables.versions.push(Version { resource, writer: self.pass, access, previous: r.version });
            self.tables.resources[resource.index()].current = version;
        }
        if r.kind == AccessKind::Color {
            self.slots |= 1 << r.slot;
            self.colors = self.colors.max(r.slot + 1);
            let one_part = self.tables.plain_kinds[resource.index()] & ONE_PART != 0;
            self.color = if one_part { access } else { AccessId::NONE };
        }
        self.tables.accesses.push(Access {
            resource,
            version,
            range: r.range,
            kind: r.kind,
            mode: r.mode,
            slot: r.slot,
            clear: r.clear,
        });
        (access, version)
    }

    /// Why an access cannot be made, if so.
    fn objection(&self, resource: ResourceId, r: &Request) -> Option<DeclareReason> {
        let row = &self.tables.resources[resource.index()];
        let own = self.own();
        if let Some(earlier) = own.iter().find(|a| a.resource == resource && conflicts(row, a, r)) {
            return Some(DeclareReason::Conflict { earlier: earlier.kind.word(), later: r.kind.word() });
        }
        if row.current != r.version {
            let writer = self.tables.pass_name(self.tables.versions[row.current.index()].writer).to_owned();
            return Some(DeclareReason::Stale { writer });
        }
        if r.kind.is_depth() && self.used & DEPTHS != 0 {
            return Some(DeclareReason::SecondDepth);
        }
        if let Some(kind) = self.kind
            && let Some(reason) = wrong_kind(kind, r.kind)
        {
            return Some(reason);
        }
        if let Some(reason) = mixed(self.tables, own, self.used, r.kind) {
            return Some(reason);
        }
        incapable(row, r)
    }

    #[inline]
    fn own(&self) -> &[Access] {
        &self.tables.accesses[self.first..]
    }

    fn flag(&mut self, flag: PassFlags) {
        self.tables.passes[self.pass.index()].flags.set(flag);
    }

    #[cold]
    #[inline(never)]
    fn refuse(
        &self,
        reason: DeclareReason,
        resource: ResourceId,
        location: &'static Location<'static>,
    ) -> DeclareError {
        let resource = resource.some().map(|r| self.tables.resource_name(r).to_owned()).unwrap_or_default();
        DeclareError { reason, pass: self.tables.pass_name(self.pass).to_owned(), resource, location }
    }
}

impl Request {
    const fn new(tag: Tag, version: VersionId, range: Range, kind: AccessKind) -> Self {
        Self { tag, version, range, kind, mode: Mode::Read, slot: 0, clear: 0 }
    }
}
