//! The accessed part of a resource: levels, layers and planes of a texture, or bytes of a buffer.

use crate::format::{Aspect, Format};
use crate::id::{BytesId, ResourceId};
use crate::resource::{Dimension, TextureDesc, halved};

/// Levels, layers and planes of a texture, or bytes of a buffer.
///
/// A count of `u8::MAX` levels or `u16::MAX` layers means all remaining ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Range {
    /// First mip level, from 0.
    pub mip: u8,
    /// Number of levels.
    pub mips: u8,
    /// First array layer.
    pub layer: u16,
    /// Number of array layers.
    pub layers: u16,
    /// Planes: all, depth or stencil.
    pub aspect: Aspect,
    /// Format of the view if it is the sRGB twin of the texture's format; otherwise `None`.
    pub view: Option<Format>,
    /// Bytes of a buffer; none for a whole buffer or a texture.
    pub bytes: BytesId,
    /// One of several slices of a three-dimensional texture, numbered by `layer`. Contents are tracked by level, so a
    /// write keeps the other slices.
    pub slice: bool,
}

/// A byte range that an access refers to: a row of [`Graph::byte_ranges`](crate::graph::Tables::byte_ranges).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ByteRange {
    /// The buffer.
    pub resource: ResourceId,
    /// Offset of the first byte, in bytes.
    pub offset: u64,
    /// Number of bytes, not 0.
    pub bytes: u64,
}

impl ByteRange {
    /// Offset of the end of the range, in bytes.
    #[inline]
    pub const fn end(&self) -> u64 {
        self.offset + self.bytes
    }

    /// Returns `true` if both ranges share a byte of one buffer.
    pub fn overlaps(&self, other: &Self) -> bool {
        self.resource == other.resource && self.offset < other.end() && other.offset < self.end()
    }
}

impl Range {
    /// The whole resource in its declared format.
    pub const ALL: Self = Self {
        mip: 0,
        mips: u8::MAX,
        layer: 0,
        layers: u16::MAX,
        aspect: Aspect::All,
        view: None,
        bytes: BytesId::NONE,
        slice: false,
    };

    /// Returns the range in canonical form, so that equal ranges of one texture compare equal.
    ///
    /// Replaces a count of all remaining layers, the only plane of a format, and a view in the texture's own format by
    /// their defaults. Marks single slices of a three-dimensional texture.
    #[inline]
    #[must_use]
    pub(crate) fn canonical(mut self, texture: &TextureDesc) -> Self {
        self.slice = false;
        if texture.dimension == Dimension::D3 {
            self.slice = self.layers == 1 && halved(texture.layers.into(), self.mip.into()) > 1;
            if !self.slice {
                (self.layer, self.layers) = (0, u16::MAX);
            }
        } else if u32::from(self.layer) + u32::from(self.layers) >= texture.tracked_layers() {
            self.layers = u16::MAX;
        }
        if texture.format.planes() == 1 {
            self.aspect = Aspect::All;
        }
        self.view = self.view.filter(|view| *view != texture.format);
        self
    }

    /// Returns `true` if the range equals [`Range::ALL`].
    #[inline]
    pub const fn is_all(&self) -> bool {
        self.mip == 0
            && self.mips == u8::MAX
            && self.layer == 0
            && self.layers == u16::MAX
            && matches!(self.aspect, Aspect::All)
            && self.view.is_none()
            && self.bytes.is_none()
            && !self.slice
    }

    /// Returns the levels as `first..end`, for a texture of `count` levels.
    #[inline]
    pub const fn mip_range(&self, count: u32) -> std::ops::Range<u32> {
        let first = self.mip as u32;
        first..if self.mips == u8::MAX { count } else { first + self.mips as u32 }
    }

    /// Returns the layers as `first..end`, for a texture of `count` layers.
    #[inline]
    pub const fn layer_range(&self, count: u32) -> std::ops::Range<u32> {
        let first = self.layer as u32;
        first..if self.layers == u16::MAX { count } else { first + self.layers as u32 }
    }

    /// Returns `true` if two ranges of one texture of this format share a subresource. For buffers use
    /// [`Graph::overlap`](crate::graph::Tables::overlap).
    pub fn overlaps(&self, other: &Self, format: Format) -> bool {
        let mips = |r: &Self| r.mip_range(u32::from(u8::MAX));
        let layers = |r: &Self| r.layer_range(u32::from(u16::MAX));
        let cross = |a: std::ops::Range<u32>, b: std::ops::Range<u32>| a.start < b.end && b.start < a.end;
        let plane =
            (0..format.planes()).any(|p| self.aspect.selects_plane(format, p) && other.aspect.selects_plane(format, p));
        plane && cross(mips(self), mips(other)) && cross(layers(self), layers(other))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_overlap_by_mip_layer_and_plane() {
        let f = Format::Depth32FloatStencil8;
        let depth = Range { aspect: Aspect::Depth, ..Range::ALL };
        let stencil = Range { aspect: Aspect::Stencil, ..Range::ALL };
        assert!(!depth.overlaps(&stencil, f) && depth.overlaps(&Range::ALL, f));
        let mip = |mip| Range { mip, mips: 1, ..Range::ALL };
        assert!(!mip(0).overlaps(&mip(1), Format::R8Unorm) && mip(1).overlaps(&Range::ALL, Format::R8Unorm));
        let layer = |layer| Range { layer, layers: 2, ..Range::ALL };
        assert!(layer(0).overlaps(&layer(1), Format::R8Unorm) && !layer(0).overlaps(&layer(2), Format::R8Unorm));
    }

    #[test]
    fn equal_ranges_have_one_spelling() {
        use crate::resource::Extent;
        let desc = TextureDesc::new(Extent::FRAME, Format::Depth32Float).mips(3).layers(4);
        let range =
            |layer, layers, aspect| Range { mip: 1, mips: 1, layer, layers, aspect, ..Range::ALL }.canonical(&desc);
        let tail = range(2, u16::MAX, Aspect::All);
        assert_eq!(range(2, 2, Aspect::Depth), tail);
        assert_ne!(range(1, 3, Aspect::Depth), tail);
        assert_ne!(range(2, 1, Aspect::Depth), tail);
    }
}
