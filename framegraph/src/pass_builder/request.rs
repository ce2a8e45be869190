//! What one call of a pass asks for.

use crate::access::{AccessKind, Mode, Range};
use crate::handle::Tag;
use crate::id::VersionId;

/// How an access is made.
#[derive(Clone, Copy)]
pub(super) struct Manner {
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
    /// Offset and size in bytes; none for all of a buffer, and for a texture.
    pub(super) bytes: Option<(u64, u64)>,
    pub(super) manner: Manner,
    pub(super) clear: u32,
}

impl Manner {
    /// Of a read.
    #[inline]
    pub(super) const fn read(kind: AccessKind) -> Self {
        Self { kind, mode: Mode::Read, slot: 0 }
    }
}
