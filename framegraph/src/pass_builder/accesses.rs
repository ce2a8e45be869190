//! The accesses of a pass to textures, one call each.

use super::request::{Manner, Request};
use super::{MAX_COLORS, PassBuilder};
use crate::access::{Access, AccessKind, Intent, Mode};
use crate::error::{DeclareError, DeclareReason};
use crate::format::Aspect;
use crate::graph::PassFlags;
use crate::handle::{Part, ReadOnly, Texture, View};
use crate::id::{ResourceId, VersionId};
use crate::resolve::ResolveMode;
use std::panic::Location;

impl PassBuilder<'_> {
    /// Reads through a sampler or by texel fetch.
    ///
    /// # Errors
    /// As every access: a stale or foreign handle, a range outside of the texture, a conflict inside the pass, a format
    /// without the capability.
    #[inline]
    #[track_caller]
    pub fn sampled(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::Sampled, Location::caller())
    }

    /// Reads the texel under the fragment: stays in the tile where the device can, otherwise sampled.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[inline]
    #[track_caller]
    pub fn same_pixel(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::SamePixel, Location::caller())
    }

    /// Reads as a storage texture.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[inline]
    #[track_caller]
    pub fn storage_read(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::StorageRead, Location::caller())
    }

    /// Copies from.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[inline]
    #[track_caller]
    pub fn copy_source(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::CopySource, Location::caller())
    }

    /// Tests against depth without writing it; the pass may sample it at the same time.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`], and when the pass has a depth attachment already.
    #[inline]
    #[track_caller]
    pub fn depth_read_only(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::DepthReadOnly, Location::caller())
    }

    /// A color attachment, in the slot behind those that are taken, or else in the first free one; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`], and when the slots are used up or the range is not one level.
    #[inline]
    #[track_caller]
    pub fn color(&mut self, into: impl Into<Part>, intent: Intent) -> Result<Texture, DeclareError> {
        let mut slot = self.colors as u8;
        if slot >= MAX_COLORS {
            let Some(free) = (0..MAX_COLORS).find(|slot| !self.is_taken(*slot)) else {
                return Err(self.refuse(DeclareReason::TooManyColors, ResourceId::NONE, Location::caller()));
            };
            slot = free;
        }
        self.write(into.into(), AccessKind::Color, intent, slot, Location::caller())
    }

    /// A color attachment in a slot of the caller's choice, 0…7. Slots left out stay empty.
    ///
    /// # Errors
    /// As [`PassBuilder::color`], and when the slot is taken.
    #[inline]
    #[track_caller]
    pub fn color_at(&mut self, slot: u8, into: impl Into<Part>, intent: Intent) -> Result<Texture, DeclareError> {
        let location = Location::caller();
        if slot >= MAX_COLORS {
            return Err(self.refuse(DeclareReason::NoSuchSlot { slot }, ResourceId::NONE, location));
        }
        if self.is_taken(slot) {
            return Err(self.refuse(DeclareReason::SlotTaken { slot }, ResourceId::NONE, location));
        }
        self.write(into.into(), AccessKind::Color, intent, slot, location)
    }

    #[inline(never)]
    fn is_taken(&self, slot: u8) -> bool {
        self.own().iter().any(|a| a.kind == AccessKind::Color && a.slot == slot)
    }

    /// The depth or depth-stencil attachment, tested and written; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::color`], and when the pass has a depth attachment already.
    #[inline]
    #[track_caller]
    pub fn depth(&mut self, into: impl Into<Part>, intent: Intent) -> Result<Texture, DeclareError> {
        self.write(into.into(), AccessKind::Depth, intent, 0, Location::caller())
    }

    /// Averages a multisampled color attachment of this pass (the handle that [`PassBuilder::color`] returned) into a
    /// single-sample texture at the end of the step; returns the new version of that texture.
    ///
    /// # Errors
    /// As [`PassBuilder::resolve_as`].
    #[inline]
    #[track_caller]
    pub fn resolve(&mut self, multisampled: Texture, into: impl Into<Part>) -> Result<Texture, DeclareError> {
        self.resolve_as(ResolveMode::Average, multisampled, into)
    }

    /// Resolves a multisampled color or depth attachment of this pass, by the handle that attaching it returned (that of
    /// the texture, where depth is only tested), into a single-sample texture at the end of the step; returns the new
    /// version of that texture. Depth goes into a texture of its depth plane's format, and stencil stays behind.
    ///
    /// Where the device's store does not do that ([`Caps`](crate::Caps)), the plan has a full-screen pass that does.
    ///
    /// # Errors
    /// As [`PassBuilder::color`], and when `multisampled` is no color or depth attachment of this pass, or its format has
    /// no such resolve: depth and integers have no average.
    #[inline]
    #[track_caller]
    pub fn resolve_as(
        &mut self,
        mode: ResolveMode,
        multisampled: Texture,
        into: impl Into<Part>,
    ) -> Result<Texture, DeclareError> {
        let location = Location::caller();
        let depth = |a: &Access| a.kind.is_depth() && a.range.aspect != Aspect::Stencil;
        let attached = |a: &&Access| a.kind == AccessKind::Color || depth(a);
        let Texture { tag, version } = multisampled;
        let samples = self.own().iter().filter(attached).find(|a| a.version == version && tag == self.tables.tag);
        let Some(&Access { resource, kind, slot, .. }) = samples else {
            return Err(self.refuse(DeclareReason::NothingToResolve, ResourceId::NONE, location));
        };
        let format = self.tables.resources[resource.index()].desc.texture().map(|t| t.format);
        if let Some(format) = format.filter(|format| !mode.fits(*format)) {
            return Err(self.refuse(DeclareReason::ResolveMode { mode, format }, resource, location));
        }
        self.flags.set(PassFlags::RESOLVES);
        self.tables.resolves = true;
        let slot = if kind == AccessKind::Color { slot } else { Access::DEPTH };
        let written = self.write(into.into(), AccessKind::Resolve, Intent::Overwrite, slot, location)?;
        self.resolved_by(mode);
        Ok(written)
    }

    /// Notes the mode of the resolve that was declared last.
    #[inline]
    pub(super) fn resolved_by(&mut self, mode: ResolveMode) {
        if let Some(access) = self.tables.accesses.last_mut() {
            access.resolve = mode;
        }
    }

    /// Writes (with `Modify`: reads and writes) as a storage texture; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[inline]
    #[track_caller]
    pub fn storage_write(&mut self, into: impl Into<Part>, intent: Intent) -> Result<Texture, DeclareError> {
        self.write(into.into(), AccessKind::StorageWrite, intent, 0, Location::caller())
    }

    /// Copies into; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[inline]
    #[track_caller]
    pub fn copy_target(&mut self, into: impl Into<Part>, intent: Intent) -> Result<Texture, DeclareError> {
        self.write(into.into(), AccessKind::CopyTarget, intent, 0, Location::caller())
    }

    #[inline(always)]
    fn read(
        &mut self,
        part: ReadOnly,
        kind: AccessKind,
        location: &'static Location<'static>,
    ) -> Result<View, DeclareError> {
        let ReadOnly { tag, version, range } = part;
        // Known where the handle is that of a whole texture, so that only one of the two calls is left.
        if range.is_all()
            && let Some(access) = self.quick_read(tag, version, kind)
        {
            return Ok(View { tag, access });
        }
        let request = Request { tag, version, range, bytes: None, manner: Manner::read(kind), clear: 0 };
        let (access, _) = self.add_checked(&request, location)?;
        Ok(View { tag, access })
    }

    /// Writes a texture: `kind` is one of writes.
    #[inline(always)]
    fn write(
        &mut self,
        part: Part,
        kind: AccessKind,
        intent: Intent,
        slot: u8,
        location: &'static Location<'static>,
    ) -> Result<Texture, DeclareError> {
        let Part { texture: Texture { tag, version }, range } = part;
        let (mode, clear) = self.mode(intent);
        let manner = Manner { kind, mode, slot };
        if range.is_all()
            && let Some(version) = self.quick_write(tag, version, manner, clear)
        {
            return Ok(Texture { tag, version });
        }
        let version = self.write_checked(&Request { tag, version, range, bytes: None, manner, clear }, location)?;
        Ok(Texture { tag, version })
    }

    /// Checks a write in full and adds it; a refused one leaves no clear value behind.
    #[cold]
    #[inline(never)]
    pub(super) fn write_checked(
        &mut self,
        r: &Request,
        location: &'static Location<'static>,
    ) -> Result<VersionId, DeclareError> {
        let added = self.add_checked(r, location);
        if added.is_err() && r.manner.mode == Mode::Clear {
            self.tables.clears.truncate(r.clear as usize);
        }
        added.map(|(_, version)| version)
    }

    #[inline(always)]
    pub(super) fn mode(&mut self, intent: Intent) -> (Mode, u32) {
        match intent {
            Intent::Overwrite => (Mode::Overwrite, 0),
            Intent::Modify => (Mode::Modify, 0),
            Intent::Clear(value) => {
                self.flags.set(PassFlags::CLEARS);
                self.tables.clears.push(value);
                (Mode::Clear, self.tables.clears.len() as u32 - 1)
            }
        }
    }
}
