//! Sets of kinds of access, and what resources and passes allow.

use super::AccessKind;
use crate::format::Format;
use crate::resource::{Desc, Kind, TextureDesc};

/// A set of kinds of access, a bit each, with two bits about the resource that they are of.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Kinds(u32);

impl Kinds {
    /// Nothing at all.
    pub(crate) const NONE: Self = Self(0);
    /// Beside kinds: the resource holds something, so that it can be read.
    pub(crate) const DEFINED: Self = Self(1 << 14);
    /// Beside kinds: the resource has one part, whatever the frame's size.
    pub(crate) const ONE_PART: Self = Self(1 << 15);
    /// Every kind.
    pub(crate) const ALL: Self = Self((1 << 14) - 1);

    /// The kinds that attach.
    const ATTACHMENTS: Self = {
        use AccessKind::*;
        Self::of(&[Color, Depth, DepthReadOnly, Resolve])
    };
    /// The kinds that make a depth attachment.
    pub(crate) const DEPTHS: Self = Self::of(&[AccessKind::Depth, AccessKind::DepthReadOnly]);
    /// The kinds that only a raster pass can make.
    pub(crate) const RASTER: Self =
        Self::ATTACHMENTS.union(Self::of(&[AccessKind::SamePixel, AccessKind::Vertex, AccessKind::Index]));
    /// The kinds that only a copy pass can make.
    pub(crate) const COPIES: Self = Self::of(&[AccessKind::CopySource, AccessKind::CopyTarget]);
    /// The kinds that read.
    pub(crate) const READS: Self = {
        use AccessKind::*;
        Self::of(&[DepthReadOnly, SamePixel, Sampled, StorageRead, Uniform, Vertex, Index, Indirect, CopySource])
    };
    /// The kinds that a buffer allows.
    pub(crate) const OF_BUFFERS: Self = {
        use AccessKind::*;
        Self::of(&[StorageRead, StorageWrite, Uniform, Vertex, Index, Indirect, CopySource, CopyTarget])
    };
    /// The kinds that touch the tile. They must name one level.
    pub(crate) const TILE: Self = Self::ATTACHMENTS.union(Self::one(AccessKind::SamePixel));

    /// The set of one kind.
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

    /// What is in either.
    #[inline]
    #[must_use]
    pub(crate) const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// What is in both.
    #[inline]
    #[must_use]
    pub(crate) const fn both(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// What is in `self` and not in `other`.
    #[inline]
    #[must_use]
    pub(crate) const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// Whether everything of `other` is in `self`.
    #[inline]
    pub(crate) const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// Whether anything of `other` is in `self`.
    #[inline]
    pub(crate) const fn meets(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }

    /// The kinds that a texture of one level and that format allows, and whether it has one plane.
    pub(crate) const fn of_format(format: Format) -> Self {
        OF_FORMATS[format as usize]
    }

    /// The accesses to the whole of a resource, as it is on entry, that nothing in its shape or kind rules out. A kind that is
    /// left out may still be sound.
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
            // The slices of a volume are not followed.
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

/// Whether a storage texture of this format exists (WebGPU's list, and what common adapters add to it).
const fn storable(format: Format) -> bool {
    !format.is_depth_stencil()
        && !format.is_compressed()
        && !format.is_srgb()
        && !matches!(format, Format::Rgb9e5Ufloat)
}
