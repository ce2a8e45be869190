//! The accesses of a pass, one call each.

use super::{MAX_COLORS, PassBuilder, Request};
use crate::access::{AccessKind, Intent, Mode, Range};
use crate::error::{DeclareError, DeclareReason};
use crate::handle::{Buffer, BufferView, Part, ReadOnly, Tag, Texture, View};
use crate::id::{AccessId, ResourceId, VersionId};
use std::panic::Location;

impl PassBuilder<'_> {
    /// Reads through a sampler or by texel fetch.
    ///
    /// # Errors
    /// As every access: a stale or foreign handle, a range outside of the texture, a conflict inside the pass, a format
    /// without the capability.
    #[track_caller]
    pub fn sampled(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::Sampled, Location::caller())
    }

    /// Reads the texel under the fragment: stays in the tile where the device can, otherwise sampled.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[track_caller]
    pub fn same_pixel(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::SamePixel, Location::caller())
    }

    /// Reads as a storage texture.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[track_caller]
    pub fn storage_read(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::StorageRead, Location::caller())
    }

    /// Copies from.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[track_caller]
    pub fn copy_source(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::CopySource, Location::caller())
    }

    /// Tests against depth without writing it; the pass may sample it at the same time.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`], and when the pass has a depth attachment already.
    #[track_caller]
    pub fn depth_read_only(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::DepthReadOnly, Location::caller())
    }

    /// A color attachment in the next free slot; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`], and when the slots are used up or the range is not one level.
    #[track_caller]
    pub fn color(&mut self, into: impl Into<Part>, intent: Intent) -> Result<Texture, DeclareError> {
        self.color_part(self.colors, into.into(), intent, Location::caller())
    }

    /// A color attachment in a slot of the caller's choice, 0…7. Slots left out stay empty.
    ///
    /// # Errors
    /// As [`PassBuilder::color`], and when the slot is taken.
    #[track_caller]
    pub fn color_at(&mut self, slot: u8, into: impl Into<Part>, intent: Intent) -> Result<Texture, DeclareError> {
        self.color_part(slot, into.into(), intent, Location::caller())
    }

    /// The depth or depth-stencil attachment, tested and written; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::color`], and when the pass has a depth attachment already.
    #[track_caller]
    pub fn depth(&mut self, into: impl Into<Part>, intent: Intent) -> Result<Texture, DeclareError> {
        self.write(into.into(), AccessKind::Depth, intent, 0, Location::caller())
    }

    /// Averages a multisampled color attachment of this pass (the handle that [`PassBuilder::color`] returned) into a
    /// single-sample texture at the end of the step; returns the new version of that texture.
    ///
    /// # Errors
    /// As [`PassBuilder::color`], and when `multisampled` is no color attachment of this pass.
    #[track_caller]
    pub fn resolve(&mut self, multisampled: Texture, into: impl Into<Part>) -> Result<Texture, DeclareError> {
        let location = Location::caller();
        let slot = self
            .own()
            .iter()
            .find(|a| a.kind == AccessKind::Color && a.version == multisampled.version)
            .map(|a| a.slot);
        match slot {
            Some(slot) if multisampled.tag == self.tables.tag => {
                self.write(into.into(), AccessKind::Resolve, Intent::Overwrite, slot, location)
            }
            _ => Err(self.refuse(DeclareReason::NothingToResolve, ResourceId::NONE, location)),
        }
    }

    /// Writes (with `Modify`: reads and writes) as a storage texture; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[track_caller]
    pub fn storage_write(&mut self, into: impl Into<Part>, intent: Intent) -> Result<Texture, DeclareError> {
        self.write(into.into(), AccessKind::StorageWrite, intent, 0, Location::caller())
    }

    /// Copies into; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[track_caller]
    pub fn copy_target(&mut self, into: impl Into<Part>, intent: Intent) -> Result<Texture, DeclareError> {
        self.write(into.into(), AccessKind::CopyTarget, intent, 0, Location::caller())
    }

    /// Reads a buffer as uniform, vertex, index, indirect, storage or copy source.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`]; also when `kind` is not a read of a buffer.
    #[track_caller]
    pub fn read_buffer(&mut self, buffer: Buffer, kind: AccessKind) -> Result<BufferView, DeclareError> {
        let location = Location::caller();
        let request = Request::new(buffer.tag, buffer.version, Range::ALL, kind);
        let (access, _) = self.push(&request, location)?;
        Ok(BufferView { tag: buffer.tag, access })
    }

    /// Writes a buffer as storage or copy target; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`]; also when `kind` is not a write of a buffer.
    #[track_caller]
    pub fn write_buffer(&mut self, buffer: Buffer, kind: AccessKind, intent: Intent) -> Result<Buffer, DeclareError> {
        let location = Location::caller();
        let (mode, clear) = self.mode(intent);
        let request = Request { mode, clear, ..Request::new(buffer.tag, buffer.version, Range::ALL, kind) };
        let (_, version) = self.push_write(&request, location)?;
        Ok(Buffer { tag: buffer.tag, version })
    }

    #[inline(always)]
    fn read(
        &mut self,
        part: ReadOnly,
        kind: AccessKind,
        location: &'static Location<'static>,
    ) -> Result<View, DeclareError> {
        // Known where the handle is that of a whole texture, so that only one of the two calls is left.
        if part.range.is_all() {
            self.read_whole(part.tag, part.version, kind, location)
        } else {
            self.read_part(part, kind, location)
        }
    }

    /// Reads a whole texture: `kind` is one of reads.
    #[inline(never)]
    fn read_whole(
        &mut self,
        tag: Tag,
        version: VersionId,
        kind: AccessKind,
        location: &'static Location<'static>,
    ) -> Result<View, DeclareError> {
        let Some(resource) = self.plain(tag, version, kind, Mode::Read) else {
            let whole = Texture { tag, version };
            return self.read_part(whole.read_only(), kind, location);
        };
        let request = Request::new(tag, version, Range::ALL, kind);
        let (access, _) = self.add(resource, &request);
        Ok(View { tag, access })
    }

    #[inline(never)]
    fn read_part(
        &mut self,
        part: ReadOnly,
        kind: AccessKind,
        location: &'static Location<'static>,
    ) -> Result<View, DeclareError> {
        let request = Request::new(part.tag, part.version, part.range, kind);
        let (access, _) = self.push(&request, location)?;
        Ok(View { tag: part.tag, access })
    }

    #[inline(always)]
    fn color_part(
        &mut self,
        slot: u8,
        part: Part,
        intent: Intent,
        location: &'static Location<'static>,
    ) -> Result<Texture, DeclareError> {
        if slot >= MAX_COLORS || self.slots & (1 << slot) != 0 {
            let reason =
                if slot >= MAX_COLORS { DeclareReason::TooManyColors } else { DeclareReason::SlotTaken { slot } };
            return Err(self.refuse(reason, ResourceId::NONE, location));
        }
        self.write(part, AccessKind::Color, intent, slot, location)
    }

    /// Writes a texture: `kind` is one of writes.
    #[inline(never)]
    fn write(
        &mut self,
        part: Part,
        kind: AccessKind,
        intent: Intent,
        slot: u8,
        location: &'static Location<'static>,
    ) -> Result<Texture, DeclareError> {
        let Texture { tag, version } = part.texture;
        let (mode, clear) = self.mode(intent);
        let plain = if part.range.is_all() { self.plain(tag, version, kind, mode) } else { None };
        let Some(resource) = plain else {
            return self.write_part(part, kind, mode, clear, slot, location);
        };
        let request = Request { mode, slot, clear, ..Request::new(tag, version, Range::ALL, kind) };
        let (_, version) = self.add(resource, &request);
        Ok(Texture { tag, version })
    }

    #[inline(never)]
    fn write_part(
        &mut self,
        part: Part,
        kind: AccessKind,
        mode: Mode,
        clear: u32,
        slot: u8,
        location: &'static Location<'static>,
    ) -> Result<Texture, DeclareError> {
        let Texture { tag, version } = part.texture;
        let request = Request { mode, slot, clear, ..Request::new(tag, version, part.range, kind) };
        let (_, version) = self.push_write(&request, location)?;
        Ok(Texture { tag, version })
    }

    /// Checks a write in full and adds it; a refused one leaves no clear value behind.
    fn push_write(
        &mut self,
        r: &Request,
        location: &'static Location<'static>,
    ) -> Result<(AccessId, VersionId), DeclareError> {
        let pushed = self.push(r, location);
        if pushed.is_err() && r.mode == Mode::Clear {
            self.tables.clears.truncate(r.clear as usize);
        }
        pushed
    }

    #[inline]
    fn mode(&mut self, intent: Intent) -> (Mode, u32) {
        match intent {
            Intent::Overwrite => (Mode::Overwrite, 0),
            Intent::Modify => (Mode::Modify, 0),
            Intent::Clear(value) => {
                self.tables.clears.push(value);
                (Mode::Clear, self.tables.clears.len() as u32 - 1)
            }
        }
    }
}
