//! Texture accesses of a pass.

use super::request::{AccessDesc, Request};
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
    /// Declares a sampled texture, read through a sampler or by texel fetch.
    ///
    /// # Errors
    /// Returns an error if
    ///
    /// - the handle is stale or belongs to another graph,
    /// - the range lies outside of the texture,
    /// - the access conflicts with another one of the pass, or
    /// - the format does not support the access.
    #[inline]
    #[track_caller]
    pub fn sampled(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::Sampled, Location::caller())
    }

    /// Declares a read of the texel under the fragment (input attachment). The value stays in the tile if the device
    /// supports it ([`Caps::same_pixel`](crate::Caps::same_pixel)); otherwise the texture is sampled.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::sampled`].
    #[inline]
    #[track_caller]
    pub fn same_pixel(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::SamePixel, Location::caller())
    }

    /// Declares a storage texture that is only read.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::sampled`].
    #[inline]
    #[track_caller]
    pub fn storage_read(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::StorageRead, Location::caller())
    }

    /// Declares the source of a texture copy.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::sampled`].
    #[inline]
    #[track_caller]
    pub fn copy_source(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::CopySource, Location::caller())
    }

    /// Declares a read-only depth attachment. The pass may sample the texture at the same time.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::sampled`], and an error if the pass already has a depth attachment.
    #[inline]
    #[track_caller]
    pub fn depth_read_only(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::DepthReadOnly, Location::caller())
    }

    /// Declares a color attachment and returns its new version.
    ///
    /// Uses the slot after the highest one in use, or the first free slot if that one does not exist.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::sampled`], and an error if all slots are in use or the range covers several
    /// levels.
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

    /// Declares a color attachment in the given slot, 0 to 7, and returns its new version. Unused slots stay empty.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::color`], and an error if the slot is in use.
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

    /// Declares a depth or depth-stencil attachment that is tested and written, and returns its new version.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::color`], and an error if the pass already has a depth attachment.
    #[inline]
    #[track_caller]
    pub fn depth(&mut self, into: impl Into<Part>, intent: Intent) -> Result<Texture, DeclareError> {
        self.write(into.into(), AccessKind::Depth, intent, 0, Location::caller())
    }

    /// Averages a multisampled color attachment of this pass into a single-sample texture at the end of the step.
    ///
    /// `multisampled` is the handle that [`PassBuilder::color`] returned. Returns the new version of the single-sample
    /// texture.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::resolve_as`].
    #[inline]
    #[track_caller]
    pub fn resolve(&mut self, multisampled: Texture, into: impl Into<Part>) -> Result<Texture, DeclareError> {
        self.resolve_as(ResolveMode::Average, multisampled, into)
    }

    /// Resolves a multisampled color or depth attachment of this pass into a single-sample texture at the end of the
    /// step.
    ///
    /// `multisampled` is the handle that declaring the attachment returned, or the texture itself for read-only depth.
    /// Returns the new version of the single-sample texture. Depth needs a target with the format of its depth plane;
    /// stencil is not resolved.
    ///
    /// If the device cannot resolve while storing ([`Caps`](crate::Caps)), the plan contains a full-screen pass
    /// instead.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::color`]. Returns an error if `multisampled` is not a color or depth
    /// attachment of this pass, or if its format does not support `mode`. Depth and integer formats cannot be averaged.
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

    /// Sets the mode of the last declared resolve.
    #[inline]
    pub(super) fn resolved_by(&mut self, mode: ResolveMode) {
        if let Some(access) = self.tables.accesses.last_mut() {
            access.resolve = mode;
        }
    }

    /// Declares a storage texture that is written, or read and written with [`Intent::Modify`]. Returns the new
    /// version.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::sampled`].
    #[inline]
    #[track_caller]
    pub fn storage_write(&mut self, into: impl Into<Part>, intent: Intent) -> Result<Texture, DeclareError> {
        self.write(into.into(), AccessKind::StorageWrite, intent, 0, Location::caller())
    }

    /// Declares the destination of a texture copy and returns its new version.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::sampled`].
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
        // Known at compile time for handles of whole textures, so that only one of the two calls remains.
        if range.is_all()
            && let Some(access) = self.try_read_fast(tag, version, kind)
        {
            return Ok(View { tag, access });
        }
        let request = Request { tag, version, range, bytes: None, desc: AccessDesc::read(kind), clear: 0 };
        let (access, _) = self.add_checked(&request, location)?;
        Ok(View { tag, access })
    }

    /// Declares a texture write; `kind` must be a write.
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
        let desc = AccessDesc { kind, mode, slot };
        if range.is_all()
            && let Some(version) = self.try_write_fast(tag, version, desc, clear)
        {
            return Ok(Texture { tag, version });
        }
        let version = self.write_checked(&Request { tag, version, range, bytes: None, desc, clear }, location)?;
        Ok(Texture { tag, version })
    }

    /// Checks a write in full and adds it. A rejected write leaves no clear value behind.
    #[cold]
    #[inline(never)]
    pub(super) fn write_checked(
        &mut self,
        r: &Request,
        location: &'static Location<'static>,
    ) -> Result<VersionId, DeclareError> {
        let added = self.add_checked(r, location);
        if added.is_err() && r.desc.mode == Mode::Clear {
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
