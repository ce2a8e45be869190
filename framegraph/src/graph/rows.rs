//! The rows of a graph's arrays: passes, versions, exports.

use crate::access::Kinds;
use crate::id::{AccessId, PassId, ResourceId, Span, VersionId};
use crate::words::words;
use std::panic::Location;

/// What kind of work a pass is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum PassKind {
    /// Draws into attachments.
    Raster,
    /// Dispatches compute work.
    Compute,
    /// Copies between resources.
    Copy,
}

words! { PassKind: Raster "raster", Compute "compute", Copy "copy" }

/// What a pass says of itself beside its accesses; a set of bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct PassFlags(u8);

impl PassFlags {
    /// Does something that no resource shows (a query, a debug print): never culled.
    pub const SIDE_EFFECT: Self = Self(1);
    /// Each output texel depends only on its `same_pixel` inputs at that texel and on constants, and every texel is
    /// covered once: the pass can become an epilogue of its producer's shader.
    pub const POINTWISE: Self = Self(2);
    /// Blends into its color attachments, so that what it writes is final only when the pass ends.
    pub const BLENDS: Self = Self(4);
    /// Must stay a step of its own.
    pub const NEVER_MERGE: Self = Self(8);
    /// Its shader can take a point-wise epilogue.
    pub const TAKES_EPILOGUE: Self = Self(16);
    /// Must run on the first queue of a device with several.
    pub const MAIN_QUEUE: Self = Self(128);
    /// Averages multisampled attachments: what its accesses tell, at hand.
    pub(crate) const RESOLVES: Self = Self(32);
    /// Clears something: what its accesses tell, at hand.
    pub(crate) const CLEARS: Self = Self(64);

    /// Whether every flag of `other` is set.
    #[inline]
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Sets the flags of `other`.
    pub(crate) const fn set(&mut self, other: Self) {
        self.0 |= other.0;
    }

    /// Takes the flags of `other` away.
    pub(crate) const fn unset(&mut self, other: Self) {
        self.0 &= !other.0;
    }
}

/// One row of [`Graph::passes`](crate::graph::Tables::passes).
#[derive(Clone, Copy, Debug)]
pub struct Declared {
    /// Its full name in the graph's text.
    pub name: Span,
    /// Its rows of [`Graph::accesses`](crate::graph::Tables::accesses).
    pub accesses: Span,
    /// Raster, compute or copy.
    pub kind: PassKind,
    /// What it says of itself.
    pub flags: PassFlags,
    /// Its attachment where it has a single one, the color attachment of a texture of one part, and reads nothing at the
    /// same pixel: what its accesses tell, at hand.
    pub(crate) sole_color: AccessId,
    /// Where it was added.
    pub location: &'static Location<'static>,
}

impl PartialEq for Declared {
    /// Equal in all but the source location, which no plan depends on, and what follows from the accesses.
    fn eq(&self, other: &Self) -> bool {
        let Self { name, accesses, kind, flags, sole_color: _, location: _ } = *self;
        (name, accesses, kind, flags) == (other.name, other.accesses, other.kind, other.flags)
    }
}

/// One version of one resource.
#[derive(Clone, Copy, Debug)]
pub struct Version {
    /// The resource that it is a version of.
    pub resource: ResourceId,
    /// The pass that wrote it; none for the contents on entry.
    pub writer: PassId,
    /// The access that wrote it.
    pub access: AccessId,
    /// The version that it replaced; none for the contents on entry.
    pub previous: VersionId,
    /// The last pass that read it.
    pub(crate) reader: PassId,
    /// The accesses to the whole resource that nothing in its shape or kind rules out; none once it is replaced.
    pub(crate) open: Kinds,
}

impl PartialEq for Version {
    /// Equal in what was declared; the rest only serves declaring.
    fn eq(&self, other: &Self) -> bool {
        let Self { resource, writer, access, previous, reader: _, open: _ } = *self;
        (resource, writer, access, previous) == (other.resource, other.writer, other.access, other.previous)
    }
}

impl Eq for Version {}

/// One row of [`Graph::notes`](crate::graph::Tables::notes).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Note {
    /// What it is about, in the graph's text.
    pub(crate) about: Span,
    /// What it says.
    pub(crate) text: Span,
}

/// What an export is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportKind {
    /// The contents must exist when the frame ends.
    Keep,
    /// As `Keep`, and they are copied out to the CPU.
    Readback,
}

/// One row of [`Graph::exports`](crate::graph::Tables::exports): a root of culling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Export {
    /// What must survive.
    pub resource: ResourceId,
    /// The version that was meant.
    pub version: VersionId,
    /// What for.
    pub kind: ExportKind,
}
