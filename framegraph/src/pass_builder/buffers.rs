//! Buffer accesses of a pass.

use super::PassBuilder;
use super::request::{AccessDesc, Request};
use crate::access::{AccessKind, Intent, Kinds, Range};
use crate::error::DeclareError;
use crate::handle::{Buffer, BufferPart, BufferView};
use std::panic::Location;

/// Methods for buffers take a whole buffer or a range of its bytes:
///
/// ```
/// use framegraph::{ClearValue, DeclareError, Graph, Intent};
///
/// let mut graph = Graph::new();
/// let args = graph.buffer("draw arguments and counter", 512);
/// // The counter starts from zero; the arguments are written whole.
/// let args = graph.add_fn("cull", |pass| {
///     let args = pass.storage_write_buffer(args.bytes(256, 4), Intent::Clear(ClearValue::Zero))?;
///     pass.storage_write_buffer(args.bytes(0, 20), Intent::Overwrite)
/// })?;
/// graph.add_fn("draw", |pass| {
///     pass.side_effect();
///     pass.indirect(args.bytes(0, 20))
/// })?;
/// # Ok::<(), DeclareError>(())
/// ```
impl PassBuilder<'_> {
    /// Declares a uniform buffer.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::read_buffer`].
    #[inline]
    #[track_caller]
    pub fn uniform(&mut self, buffer: impl Into<BufferPart>) -> Result<BufferView, DeclareError> {
        self.read_bytes(buffer.into(), AccessKind::Uniform, Location::caller())
    }

    /// Declares a vertex buffer.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::read_buffer`].
    #[inline]
    #[track_caller]
    pub fn vertex(&mut self, buffer: impl Into<BufferPart>) -> Result<BufferView, DeclareError> {
        self.read_bytes(buffer.into(), AccessKind::Vertex, Location::caller())
    }

    /// Declares an index buffer.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::read_buffer`].
    #[inline]
    #[track_caller]
    pub fn index(&mut self, buffer: impl Into<BufferPart>) -> Result<BufferView, DeclareError> {
        self.read_bytes(buffer.into(), AccessKind::Index, Location::caller())
    }

    /// Declares a buffer with the arguments of indirect draws or dispatches.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::read_buffer`].
    #[inline]
    #[track_caller]
    pub fn indirect(&mut self, buffer: impl Into<BufferPart>) -> Result<BufferView, DeclareError> {
        self.read_bytes(buffer.into(), AccessKind::Indirect, Location::caller())
    }

    /// Declares a storage buffer that is only read.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::read_buffer`].
    #[inline]
    #[track_caller]
    pub fn storage_read_buffer(&mut self, buffer: impl Into<BufferPart>) -> Result<BufferView, DeclareError> {
        self.read_bytes(buffer.into(), AccessKind::StorageRead, Location::caller())
    }

    /// Declares the source of a buffer copy.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::read_buffer`].
    #[inline]
    #[track_caller]
    pub fn copy_source_buffer(&mut self, buffer: impl Into<BufferPart>) -> Result<BufferView, DeclareError> {
        self.read_bytes(buffer.into(), AccessKind::CopySource, Location::caller())
    }

    /// Declares a storage buffer that is written, or read and written with [`Intent::Modify`]. Returns the new version.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::write_buffer`].
    #[inline]
    #[track_caller]
    pub fn storage_write_buffer(
        &mut self,
        into: impl Into<BufferPart>,
        intent: Intent,
    ) -> Result<Buffer, DeclareError> {
        self.write_bytes(into.into(), AccessKind::StorageWrite, intent, Location::caller())
    }

    /// Declares the destination of a buffer copy and returns its new version.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::write_buffer`].
    #[inline]
    #[track_caller]
    pub fn copy_target_buffer(&mut self, into: impl Into<BufferPart>, intent: Intent) -> Result<Buffer, DeclareError> {
        self.write_bytes(into.into(), AccessKind::CopyTarget, intent, Location::caller())
    }

    /// Declares a buffer read of the given kind: uniform, vertex, index, indirect, storage or copy source.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::sampled`], and an error if `kind` is not a buffer read or the range exceeds
    /// the buffer. A pass that writes part of a buffer may access its other bytes only in the same way: WebGPU allows
    /// one usage per buffer and pass.
    #[inline]
    #[track_caller]
    pub fn read_buffer(&mut self, buffer: impl Into<BufferPart>, kind: AccessKind) -> Result<BufferView, DeclareError> {
        self.read_bytes(buffer.into(), kind, Location::caller())
    }

    /// Declares a buffer write of the given kind, storage or copy target, and returns the new version.
    ///
    /// # Errors
    /// Returns the errors of [`PassBuilder::read_buffer`], and an error if `kind` is not a buffer write.
    #[inline]
    #[track_caller]
    pub fn write_buffer(
        &mut self,
        into: impl Into<BufferPart>,
        kind: AccessKind,
        intent: Intent,
    ) -> Result<Buffer, DeclareError> {
        self.write_bytes(into.into(), kind, intent, Location::caller())
    }

    #[inline(always)]
    fn read_bytes(
        &mut self,
        part: BufferPart,
        kind: AccessKind,
        location: &'static Location<'static>,
    ) -> Result<BufferView, DeclareError> {
        let BufferPart { buffer: Buffer { tag, version }, bytes } = part;
        if bytes.is_none()
            && Kinds::READS.has(Kinds::one(kind))
            && let Some(access) = self.try_read_fast(tag, version, kind)
        {
            return Ok(BufferView { tag, access });
        }
        let request = Request { tag, version, range: Range::ALL, bytes, desc: AccessDesc::read(kind), clear: 0 };
        let (access, _) = self.add_checked(&request, location)?;
        Ok(BufferView { tag, access })
    }

    #[inline(always)]
    fn write_bytes(
        &mut self,
        part: BufferPart,
        kind: AccessKind,
        intent: Intent,
        location: &'static Location<'static>,
    ) -> Result<Buffer, DeclareError> {
        let BufferPart { buffer: Buffer { tag, version }, bytes } = part;
        let (mode, clear) = self.mode(intent);
        let desc = AccessDesc { kind, mode, slot: 0 };
        if bytes.is_none()
            && !Kinds::READS.has(Kinds::one(kind))
            && let Some(version) = self.try_write_fast(tag, version, desc, clear)
        {
            return Ok(Buffer { tag, version });
        }
        let request = Request { tag, version, range: Range::ALL, bytes, desc, clear };
        let version = self.write_checked(&request, location)?;
        Ok(Buffer { tag, version })
    }
}
