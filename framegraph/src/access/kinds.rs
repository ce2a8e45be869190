//! Sets of access kinds, and the kinds that formats and resources allow.

use super::AccessKind;
use crate::format::Format;
use crate::resource::{Desc, Kind, TextureDesc};

/// A set of access kinds, one bit each, and two bits about the resource.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Kinds(u32);

impl Kinds {
    /// The empty set.
    pub(crate) const NONE: Self = Self(0);
    /// Resource bit: the contents are defined and can be read.
    pub(crate) const DEFINED: Self = Self(1 << 14);
    /// Resource bit: the resource has one subresource at any frame size.
    pub(crate) const ONE_PART: Self = Self(1 << 15);
    /// Every kind.
    pub(crate) const ALL: Self = Self((1 << 14) - 1);

    /// Attachments and resolve targets.
    const ATTACHMENTS: Self = {
        use AccessKind::*;
        Self::of(&[Color, Depth, DepthReadOnly, Resolve])
    };
    /// Depth-stencil attachments.
    pub(crate) const DEPTHS: Self = Self::of(&[AccessKind::Depth, AccessKind::DepthReadOnly]);
    /// Kinds that require a raster pass.
    pub(crate) const RASTER: Self =
        Self::ATTACHMENTS.union(Self::of(&[AccessKind::SamePixel, AccessKind::Vertex, AccessKind::Index]));
    /// Kinds that require a copy pass.
    pub(crate) const COPIES: Self = Self::of(&[AccessKind::CopySource, AccessKind::CopyTarget]);
    /// Kinds that read.
    pub(crate) const READS: Self = {
        use AccessKind::*;
        Self::of(&[DepthReadOnly, SamePixel, Sampled, StorageRead, Uniform, Vertex, Index, Indirect, CopySource])
    };
    /// Kinds that buffers support.
    pub(crate) const OF_BUFFERS: Self = {
        use AccessKind::*;
        Self::of(&[StorageRead, StorageWrite, Uniform, Vertex, Index, Indirect, CopySource, CopyTarget])
    };
    /// Kinds that access the tile. Their range must be a single level.
    pub(crate) const TILE: Self = Self::ATTACHMENTS.union(Self::one(AccessKind::SamePixel));

    /// Returns the set of one kind.
    #[inline]
    pub(crate) const fn one(kind: AccessKind) -> Self {
        Self(1 << kind as u8)
    }

    const fn of(kinds: &[AccessKind]) -> Self {
        let (mut set, mut at) = (Self::NONE, 0);
        while at < kinds.len() {
            set = set.union(Self::one(kinds[at]));
            at += 1;
        }
        set
    }

    /// Returns the union of both sets.
    #[inline]
    #[must_use]
    pub(crate) const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Returns the intersection of both sets.
    #[inline]
    #[must_use]
    pub(crate) const fn both(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Returns the elements of `self` that are not in `other`.
    #[inline]
    #[must_use]
    pub(crate) const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Returns `true` if `self` contains all of `other`.
    #[inline]
    pub(crate) const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Returns `true` if `self` and `other` intersect.
    #[inline]
    pub(crate) const fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// Returns the kinds that a single-level texture of this format supports, and `ONE_PART` if the format has one
    /// plane.
    pub(crate) const fn of_format(format: Format) -> Self {
        OF_FORMATS[format as usize]
    }

    /// Returns the kinds that the descriptor and origin of a resource allow for its initial version.
    ///
    /// The set is conservative: a missing kind may still be valid, and needs the full check.
    #[inline]
    pub(crate) const fn on_entry(desc: &Desc, kind: Kind) -> Self {
        let shape = match desc {
            Desc::Buffer(_) => Self::OF_BUFFERS,
            Desc::Texture(t) => Self::of_texture(t),
        };
        match kind {
            Kind::HistoryPrevious { .. } => shape.both(Self::READS.union(Self::ONE_PART)).union(Self::DEFINED),
            kind if kind.defined_on_entry() => shape.union(Self::DEFINED),
            _ => shape,
        }
    }

    #[inline]
    const fn of_texture(t: &TextureDesc) -> Self {
        let kinds = Self::of_format(t.format);
        if t.layers == 1 && t.mips == 1 {
            kinds
        } else if t.layers == 0 {
            Self::NONE
        } else if t.mips == 1 && t.tracked_layers() == 1 {
            // Slices of three-dimensional textures are not tracked.
            kinds.without(Self::TILE)
        } else if t.mips == 1 {
            kinds.without(Self::ONE_PART)
        } else {
            kinds.without(Self::TILE.union(Self::ONE_PART))
        }
    }
}

const OF_FORMATS: [Kinds; Format::ALL.len()] = {
    let mut table = [Kinds::NONE; Format::ALL.len()];
    let mut at = 0;
    while at < table.len() {
        table[at] = allowed_by(Format::ALL[at]);
        at += 1;
    }
    table
};

const fn allowed_by(format: Format) -> Kinds {
    use AccessKind::*;
    let mut kinds = Kinds::of(&[SamePixel, Sampled, CopySource, CopyTarget]);
    if format.is_color_renderable() {
        kinds = kinds.union(Kinds::one(Color));
    }
    if format.is_color_renderable() || format.has_depth() && !format.has_stencil() {
        kinds = kinds.union(Kinds::one(Resolve));
    }
    if format.is_depth_stencil() {
        kinds = kinds.union(Kinds::DEPTHS);
    }
    if storable(format) {
        kinds = kinds.union(Kinds::of(&[StorageRead, StorageWrite]));
    }
    if format.planes() == 1 { kinds.union(Kinds::ONE_PART) } else { kinds }
}

/// Returns `true` if storage textures of this format exist, in WebGPU or with common adapter features.
const fn storable(format: Format) -> bool {
    !format.is_depth_stencil()
        && !format.is_compressed()
        && !format.is_srgb()
        && !matches!(format, Format::Rgb9e5Ufloat)
}
