//! The accesses of a pass, one call each.

use super::{MAX_COLORS, PassBuilder, Request};
use crate::access::{AccessKind, Intent, Mode, Range};
use crate::error::{DeclareError, DeclareReason};
use crate::handle::{Buffer, BufferView, Part, ReadOnly, Texture, View};
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
        self.read(texture.into(), AccessKind::Sampled)
    }

    /// Reads the texel under the fragment: stays in the tile where the device can, otherwise sampled.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[track_caller]
    pub fn same_pixel(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::SamePixel)
    }

    /// Reads as a storage texture.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[track_caller]
    pub fn storage_read(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::StorageRead)
    }

    /// Copies from.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[track_caller]
    pub fn copy_source(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::CopySource)
    }

    /// Tests against depth without writing it; the pass may sample it at the same time.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`], and when the pass has a depth attachment already.
    #[track_caller]
    pub fn depth_read_only(&mut self, texture: impl Into<ReadOnly>) -> Result<View, DeclareError> {
        self.read(texture.into(), AccessKind::DepthReadOnly)
    }

    /// A color attachment in the next free slot; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`], and when the slots are used up or the range is not one level.
    #[track_caller]
    pub fn color(
        &mut self,
        into: impl Into<Part>,
        intent: Intent,
    ) -> Result<Texture, DeclareError> {
        let slot = self.colors;
        self.color_at(slot, into, intent)
    }

    /// A color attachment in a slot of the caller's choice, 0…7. Slots left out stay empty.
    ///
    /// # Errors
    /// As [`PassBuilder::color`], and when the slot is taken.
    #[track_caller]
    pub fn color_at(
        &mut self,
        slot: u8,
        into: impl Into<Part>,
        intent: Intent,
    ) -> Result<Texture, DeclareError> {
        let location = Location::caller();
        if slot >= MAX_COLORS {
            return Err(self.refuse(DeclareReason::TooManyColors, ResourceId::NONE, location));
        }
        if self
            .own()
            .iter()
            .any(|a| a.kind == AccessKind::Color && a.slot == slot)
        {
            return Err(self.refuse(
                DeclareReason::SlotTaken { slot },
                ResourceId::NONE,
                location,
            ));
        }
        let version = self.write(into.into(), AccessKind::Color, intent, slot, location)?;
        self.colors = self.colors.max(slot + 1);
        Ok(version)
    }

    /// The depth or depth-stencil attachment, tested and written; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::color`], and when the pass has a depth attachment already.
    #[track_caller]
    pub fn depth(
        &mut self,
        into: impl Into<Part>,
        intent: Intent,
    ) -> Result<Texture, DeclareError> {
        self.write(
            into.into(),
            AccessKind::Depth,
            intent,
            0,
            Location::caller(),
        )
    }

    /// Averages a multisampled color attachment of this pass (the handle that [`PassBuilder::color`] returned) into a
    /// single-sample texture at the end of the step; returns the new version of that texture.
    ///
    /// # Errors
    /// As [`PassBuilder::color`], and when `multisampled` is no color attachment of this pass.
    #[track_caller]
    pub fn resolve(
        &mut self,
        multisampled: Texture,
        into: impl Into<Part>,
    ) -> Result<Texture, DeclareError> {
        let location = Location::caller();
        let slot = self
            .own()
            .iter()
            .find(|a| a.kind == AccessKind::Color && a.version == multisampled.version)
            .map(|a| a.slot);
        match slot {
            Some(slot) if multisampled.tag == self.graph.tag => self.write(
                into.into(),
                AccessKind::Resolve,
                Intent::Overwrite,
                slot,
                location,
            ),
            _ => Err(self.refuse(DeclareReason::NothingToResolve, ResourceId::NONE, location)),
        }
    }

    /// Writes (with `Modify`: reads and writes) as a storage texture; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[track_caller]
    pub fn storage_write(
        &mut self,
        into: impl Into<Part>,
        intent: Intent,
    ) -> Result<Texture, DeclareError> {
        self.write(
            into.into(),
            AccessKind::StorageWrite,
            intent,
            0,
            Location::caller(),
        )
    }

    /// Copies into; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`].
    #[track_caller]
    pub fn copy_target(
        &mut self,
        into: impl Into<Part>,
        intent: Intent,
    ) -> Result<Texture, DeclareError> {
        self.write(
            into.into(),
            AccessKind::CopyTarget,
            intent,
            0,
            Location::caller(),
        )
    }

    /// Reads a buffer as uniform, vertex, index, indirect, storage or copy source.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`]; also when `kind` is not a read of a buffer.
    #[track_caller]
    pub fn read_buffer(
        &mut self,
        buffer: Buffer,
        kind: AccessKind,
    ) -> Result<BufferView, DeclareError> {
        let location = Location::caller();
        let request = Request {
            mode: Mode::Read,
            ..Request::new(buffer.tag, buffer.version, Range::ALL, kind)
        };
        let (access, _) = self.push(request, location)?;
        Ok(BufferView {
            tag: buffer.tag,
            access,
        })
    }

    /// Writes a buffer as storage or copy target; returns the new version.
    ///
    /// # Errors
    /// As [`PassBuilder::sampled`]; also when `kind` is not a write of a buffer.
    #[track_caller]
    pub fn write_buffer(
        &mut self,
        buffer: Buffer,
        kind: AccessKind,
        intent: Intent,
    ) -> Result<Buffer, DeclareError> {
        let location = Location::caller();
        let request = Request::new(buffer.tag, buffer.version, Range::ALL, kind);
        let (_, version) = self.push_write(request, intent, location)?;
        Ok(Buffer {
            tag: buffer.tag,
            version,
        })
    }

    #[track_caller]
    fn read(&mut self, part: ReadOnly, kind: AccessKind) -> Result<View, DeclareError> {
        let request = Request {
            mode: Mode::Read,
            ..Request::new(part.tag, part.version, part.range, kind)
        };
        let (access, _) = self.push(request, Location::caller())?;
        Ok(View {
            tag: part.tag,
            access,
        })
    }

    fn write(
        &mut self,
        part: Part,
        kind: AccessKind,
        intent: Intent,
        slot: u8,
        location: &'static Location<'static>,
    ) -> Result<Texture, DeclareError> {
        let Part {
            texture: Texture { tag, version },
            range,
        } = part;
        let request = Request {
            slot,
            ..Request::new(tag, version, range, kind)
        };
        let (_, version) = self.push_write(request, intent, location)?;
        Ok(Texture { tag, version })
    }

    /// Adds a write with what its intent says; a refused one leaves no clear value behind.
    fn push_write(
        &mut self,
        request: Request,
        intent: Intent,
        location: &'static Location<'static>,
    ) -> Result<(AccessId, VersionId), DeclareError> {
        let clears = self.graph.clears.len();
        let (mode, clear) = match intent {
            Intent::Overwrite => (Mode::Overwrite, 0),
            Intent::Modify => (Mode::Modify, 0),
            Intent::Clear(value) => {
                self.graph.clears.push(value);
                (Mode::Clear, clears as u32)
            }
        };
        let request = Request {
            mode,
            clear,
            ..request
        };
        let pushed = self.push(request, location);
        if pushed.is_err() {
            self.graph.clears.truncate(clears);
        }
        pushed
    }
}
