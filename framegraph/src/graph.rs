//! What was declared: flat arrays, the compiler's only input.
//!
//! A [`Graph`] is filled through [`Graph::add`] and the calls beside it, read by the phases, dumped, compared and copied;
//! it holds no closure and no GPU object. Declared anew each frame ([`Graph::reset`]) it keeps its memory, so a warm graph
//! allocates nothing.

use crate::access::{Access, ClearValue};
use crate::error::DeclareError;
use crate::handle::Tag;
use crate::id::{AccessId, PassId, ResourceId, Span, VersionId};
use crate::resource::Resource;
use serde::{Deserialize, Serialize};
use std::panic::Location;

/// What kind of work a pass is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[repr(u8)]
pub enum PassKind {
    /// Draws into attachments.
    Raster,
    /// Dispatches compute work.
    Compute,
    /// Copies between resources.
    Copy,
}

impl PassKind {
    /// The word that dumps and errors use.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Raster => "raster",
            Self::Compute => "compute",
            Self::Copy => "copy",
        }
    }
}

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

/// One row of [`Graph::passes`].
#[derive(Clone, Copy, Debug)]
pub struct Declared {
    /// Its full name in the graph's text.
    pub name: Span,
    /// Its rows of [`Graph::accesses`].
    pub accesses: Span,
    /// Raster, compute or copy.
    pub kind: PassKind,
    /// What it says of itself.
    pub flags: PassFlags,
    /// Where it was added.
    pub location: &'static Location<'static>,
}

impl PartialEq for Declared {
    /// Equal in all but the source location, which no plan depends on.
    fn eq(&self, other: &Self) -> bool {
        let Self { name, accesses, kind, flags, location: _ } = *self;
        (name, accesses, kind, flags) == (other.name, other.accesses, other.kind, other.flags)
    }
}

/// One version of one resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Version {
    /// Whose.
    pub resource: ResourceId,
    /// The pass that wrote it; none for the contents on entry.
    pub writer: PassId,
    /// The access that wrote it.
    pub access: AccessId,
    /// The version that it replaced; none for the contents on entry.
    pub previous: VersionId,
}

/// What an export is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ExportKind {
    /// The contents must exist when the frame ends.
    Keep,
    /// As `Keep`, and somebody copies them out to the CPU.
    Readback,
}

/// One row of [`Graph::exports`]: a root of culling.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Export {
    /// What must survive.
    pub resource: ResourceId,
    /// The version that was meant.
    pub version: VersionId,
    /// What for.
    pub kind: ExportKind,
}

/// Everything that was declared for a frame.
#[derive(Debug, Default)]
pub struct Graph {
    pub(crate) identity: Box<u8>,
    pub(crate) resets: u32,
    pub(crate) tag: Tag,
    pub(crate) names: String,
    pub(crate) passes: Vec<Declared>,
    pub(crate) accesses: Vec<Access>,
    pub(crate) resources: Vec<Resource>,
    pub(crate) versions: Vec<Version>,
    pub(crate) clears: Vec<ClearValue>,
    pub(crate) exports: Vec<Export>,
    /// Errors of calls that return no `Result`; reported by compiling.
    pub(crate) errors: Vec<DeclareError>,
    pub(crate) prefix: String,
    /// For each resource, the kinds of access to the whole of it that nothing in its shape rules out, a bit each.
    pub(crate) plain_kinds: Vec<u16>,
    /// For each pass, its attachment where it has a single one, the color attachment of a texture of one part, and reads
    /// nothing at the same pixel.
    pub(crate) sole_colors: Vec<AccessId>,
    /// Parts of resources are named, or contents on entry are read: whether all that is read was written takes a sweep.
    pub(crate) doubts: bool,
}

impl Graph {
    /// An empty graph.
    pub fn new() -> Self {
        let mut graph = Self::default();
        graph.retag();
        graph
    }

    /// Forgets what was declared and keeps the memory; handles of before are refused from now on.
    pub fn reset(&mut self) {
        let Self {
            identity: _,
            resets,
            tag: _,
            names,
            passes,
            accesses,
            resources,
            versions,
            clears,
            exports,
            errors,
            prefix,
            plain_kinds,
            sole_colors,
            doubts,
        } = self;
        names.clear();
        passes.clear();
        accesses.clear();
        resources.clear();
        versions.clear();
        clears.clear();
        exports.clear();
        errors.clear();
        prefix.clear();
        plain_kinds.clear();
        sole_colors.clear();
        *doubts = false;
        *resets = resets.wrapping_add(1);
        self.retag();
    }

    fn retag(&mut self) {
        let address = std::ptr::from_ref::<u8>(&*self.identity).addr() as u64;
        let mixed = (address ^ (u64::from(self.resets) << 40)).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        self.tag = Tag((mixed >> 32) as u32);
    }

    /// The declared passes, in declaration order.
    pub fn passes(&self) -> &[Declared] {
        &self.passes
    }

    /// The accesses of all passes; each pass owns a span.
    pub fn accesses(&self) -> &[Access] {
        &self.accesses
    }

    /// The accesses of one pass.
    ///
    /// # Panics
    /// When `pass` is not of this graph.
    pub fn accesses_of(&self, pass: PassId) -> &[Access] {
        self.passes[pass.index()].accesses.of(&self.accesses)
    }

    /// The declared resources.
    pub fn resources(&self) -> &[Resource] {
        &self.resources
    }

    /// All versions of all resources, in the order in which they came to be.
    pub fn versions(&self) -> &[Version] {
        &self.versions
    }

    /// The clear values that accesses name.
    pub fn clears(&self) -> &[ClearValue] {
        &self.clears
    }

    /// What the frame is for.
    pub fn exports(&self) -> &[Export] {
        &self.exports
    }

    /// The full name of a pass, `effect/pass`.
    ///
    /// # Panics
    /// When `pass` is not of this graph.
    pub fn pass_name(&self, pass: PassId) -> &str {
        &self.names[self.passes[pass.index()].name.range()]
    }

    /// The full name of a resource.
    ///
    /// # Panics
    /// When `resource` is not of this graph.
    pub fn resource_name(&self, resource: ResourceId) -> &str {
        &self.names[self.resources[resource.index()].name.range()]
    }

    /// The ids of all passes.
    pub fn pass_ids(&self) -> impl DoubleEndedIterator<Item = PassId> + ExactSizeIterator + use<> {
        (0..self.passes.len()).map(PassId::at)
    }

    /// The ids of all resources.
    pub fn resource_ids(&self) -> impl DoubleEndedIterator<Item = ResourceId> + ExactSizeIterator + use<> {
        (0..self.resources.len()).map(ResourceId::at)
    }

    /// The first pass of that full name.
    pub fn find_pass(&self, name: &str) -> Option<PassId> {
        self.pass_ids().find(|p| self.pass_name(*p) == name)
    }

    /// The first resource of that full name.
    pub fn find_resource(&self, name: &str) -> Option<ResourceId> {
        self.resource_ids().find(|r| self.resource_name(*r) == name)
    }

    /// Whether the two would compile to the same plan: everything but source locations is equal, clear values bit for bit.
    pub fn same_as(&self, other: &Self) -> bool {
        self.passes == other.passes
            && self.accesses == other.accesses
            && self.resources == other.resources
            && self.exports == other.exports
            && self.versions == other.versions
            && self.names == other.names
            && self.errors.is_empty()
            && other.errors.is_empty()
            && self.clears.len() == other.clears.len()
            && self.clears.iter().zip(&other.clears).all(|(a, b)| a.same_bits(b))
    }

    /// Makes the handles of an equal graph work on this one.
    pub(crate) fn adopt_tag(&mut self, equal: &Self) {
        self.tag = equal.tag;
        self.resets = equal.resets;
    }

    /// Becomes a copy of `source`, handles included, reusing memory.
    pub(crate) fn copy_from(&mut self, source: &Self) {
        let Self {
            identity: _,
            resets,
            tag,
            names,
            passes,
            accesses,
            resources,
            versions,
            clears,
            exports,
            errors,
            prefix,
            plain_kinds,
            sole_colors,
            doubts,
        } = self;
        *resets = source.resets;
        *tag = source.tag;
        names.clone_from(&source.names);
        passes.clone_from(&source.passes);
        accesses.clone_from(&source.accesses);
        resources.clone_from(&source.resources);
        versions.clone_from(&source.versions);
        clears.clone_from(&source.clears);
        exports.clone_from(&source.exports);
        errors.clone_from(&source.errors);
        prefix.clone_from(&source.prefix);
        plain_kinds.clone_from(&source.plain_kinds);
        sole_colors.clone_from(&source.sole_colors);
        *doubts = source.doubts;
    }
}

impl Clone for Graph {
    /// A copy that the same handles work on.
    fn clone(&self) -> Self {
        let mut copy = Self::default();
        copy.copy_from(self);
        copy
    }
}
