//! Arguments of one declared access.

use crate::access::{AccessKind, Mode, Range};
use crate::handle::Tag;
use crate::id::VersionId;

/// Kind, mode and color slot of an access.
#[derive(Clone, Copy)]
pub(super) struct AccessDesc {
    pub(super) kind: AccessKind,
    pub(super) mode: Mode,
    pub(super) slot: u8,
}

/// One access that is about to be checked and added.
#[derive(Clone, Copy)]
pub(super) struct Request {
    pub(super) tag: Tag,
    pub(super) version: VersionId,
    pub(super) range: Range,
    /// Offset and size in bytes; `None` for a whole buffer or a texture.
    pub(super) bytes: Option<(u64, u64)>,
    pub(super) desc: AccessDesc,
    pub(super) clear: u32,
}

impl AccessDesc {
    /// Returns the description of a read.
    #[inline]
    pub(super) const fn read(kind: AccessKind) -> Self {
        Self { kind, mode: Mode::Read, slot: 0 }
    }
}
