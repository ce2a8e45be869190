//! Row types of a graph's arrays: passes, versions, notes and exports.

use crate::access::Kinds;
use crate::enum_names::enum_names;
use crate::id::{AccessId, PassId, ResourceId, Span, VersionId};
use std::panic::Location;

/// The kind of work that a pass does.
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

enum_names! { PassKind: Raster "raster", Compute "compute", Copy "copy" }

/// Properties of a pass beyond its accesses, as a set of bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct PassFlags(u16);

impl PassFlags {
    /// The pass has an effect outside of its declared resources, such as a query or a debug print. Never culled.
    pub const SIDE_EFFECT: Self = Self(1);
    /// Each output texel depends only on the `same_pixel` inputs at that texel and on constants, and every texel is
    /// covered once. The compiler may append the pass to its producer's shader as an epilogue.
    pub const POINTWISE: Self = Self(2);
    /// The pass blends into its color attachments, so its output is final only when the pass ends.
    pub const BLENDS: Self = Self(4);
    /// The pass must not be merged with other passes.
    pub const NEVER_MERGE: Self = Self(8);
    /// The pass's shader accepts a point-wise epilogue.
    pub const TAKES_EPILOGUE: Self = Self(16);
    /// The pass must run on the first queue of a device with several queues.
    pub const MAIN_QUEUE: Self = Self(128);
    /// The pass resolves multisampled attachments. Derived from its accesses.
    pub(crate) const RESOLVES: Self = Self(32);
    /// The pass clears a resource. Derived from its accesses.
    pub(crate) const CLEARS: Self = Self(64);
    /// The pass accesses an import that may alias another one: it keeps its place, and is neither culled nor merged.
    /// Derived from its accesses.
    const ALIASED: Self = Self(Self::DERIVED | Self::SIDE_EFFECT.0 | Self::NEVER_MERGE.0);
    const DERIVED: u16 = 256;
    /// Distance in bits from a flag that [`ALIASED`](Self::ALIASED) implies to the mark that it was declared.
    const DECLARED: u32 = 9;

    /// Returns `true` if every flag of `other` is set.
    #[inline]
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Sets the flags of a pass that accesses an import that may alias another one.
    pub(crate) const fn alias(&mut self) {
        if self.0 & Self::DERIVED == 0 {
            self.0 |= (self.0 & (Self::SIDE_EFFECT.0 | Self::NEVER_MERGE.0)) << Self::DECLARED;
        }
        self.0 |= Self::ALIASED.0;
    }

    /// Returns the flags without those that only an alias implies.
    #[cfg(feature = "files")]
    pub(crate) const fn declared(self) -> Self {
        let implied = Self::SIDE_EFFECT.0 | Self::NEVER_MERGE.0;
        if self.0 & Self::DERIVED != 0 { Self(self.0 & !implied | self.0 >> Self::DECLARED & implied) } else { self }
    }

    /// Sets the flags of `other`.
    pub(crate) const fn set(&mut self, other: Self) {
        self.0 |= other.0;
    }

    /// Clears the flags of `other`.
    pub(crate) const fn unset(&mut self, other: Self) {
        self.0 &= !other.0;
    }
}

/// One row of [`Graph::passes`](crate::graph::Tables::passes).
#[derive(Clone, Copy, Debug)]
pub struct Declared {
    /// Full name of the pass, as a span of the graph's text.
    pub name: Span,
    /// The pass's rows in [`Graph::accesses`](crate::graph::Tables::accesses).
    pub accesses: Span,
    /// Raster, compute or copy.
    pub kind: PassKind,
    /// Properties beyond its accesses.
    pub flags: PassFlags,
    /// The only attachment of the pass, if it is a color attachment with one subresource and the pass reads nothing at
    /// the same pixel. Derived from its accesses.
    pub(crate) sole_color: AccessId,
    /// Source location of the call that added the pass.
    pub location: &'static Location<'static>,
}

impl PartialEq for Declared {
    /// Compares everything except the source location and fields derived from the accesses.
    fn eq(&self, other: &Self) -> bool {
        let Self { name, accesses, kind, flags, sole_color: _, location: _ } = *self;
        (name, accesses, kind, flags) == (other.name, other.accesses, other.kind, other.flags)
    }
}

/// One version of a resource: its contents between two writes.
#[derive(Clone, Copy, Debug)]
pub struct Version {
    /// The resource.
    pub resource: ResourceId,
    /// The pass that wrote this version; none for the contents at the start of the frame.
    pub writer: PassId,
    /// The access that wrote this version.
    pub access: AccessId,
    /// The version that this one replaced; none for the contents at the start of the frame.
    pub previous: VersionId,
    /// The last pass that read this version.
    pub(crate) reader: PassId,
    /// Access kinds to the whole resource that its format and kind allow; empty once a newer version exists.
    pub(crate) allowed: Kinds,
}

impl PartialEq for Version {
    /// Compares what was declared, not the fields that only serve declaring.
    fn eq(&self, other: &Self) -> bool {
        let Self { resource, writer, access, previous, reader: _, allowed: _ } = *self;
        (resource, writer, access, previous) == (other.resource, other.writer, other.access, other.previous)
    }
}

impl Eq for Version {}

/// One row of [`Graph::notes`](crate::graph::Tables::notes).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Note {
    /// The subject of the note, as a span of the graph's text.
    pub(crate) about: Span,
    /// The text of the note, as a span of the graph's text.
    pub(crate) text: Span,
}

/// The purpose of an export.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExportKind {
    /// The contents must exist when the frame ends.
    Keep,
    /// The contents must exist when the frame ends, and the CPU reads them.
    Readback,
}

/// One row of [`Graph::exports`](crate::graph::Tables::exports): a root of culling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Export {
    /// The resource that must survive the frame.
    pub resource: ResourceId,
    /// The exported version.
    pub version: VersionId,
    /// The purpose of the export.
    pub kind: ExportKind,
}
