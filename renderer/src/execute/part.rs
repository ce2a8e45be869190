//! Parameters and results of resource lookups.

use crate::pipelines::bind_groups::Binding;
use framegraph::{Aspect, Range};
use wgpu::{TextureView, TextureViewDimension};

/// State of a previous image of a history.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HistoryImage {
    /// True if the image has valid contents; otherwise it is zero-filled.
    ///
    /// False in the first frame, after a reset, and after the format, layers, samples or length of the history changed.
    /// Also false if the history was not written for more than
    /// [`ExecutorOptions::max_age`](crate::ExecutorOptions::max_age) frames.
    pub valid: bool,
    /// Number of times the [`Frame`](crate::Frame) was executed since without writing the history; 0 if the last frame
    /// wrote it. Passes that need the image of the last frame can reject older ones.
    pub missed: u64,
    /// Width and height in texels when the image was written; 0 if there is no image.
    ///
    /// A change of size alone keeps previous images at their old size. Exceptions are images that a pass attaches, or
    /// that lack a mip level a pass names: they are dropped. A pass that samples all levels gets those that exist.
    pub texels: [u32; 2],
}

/// Part of a declared access, and how shaders view it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ViewPart {
    /// Mip level, counted from the texture's first. `None` selects all declared levels.
    pub mip: Option<u8>,
    /// Layer, counted from the texture's first. `None` selects all declared layers.
    pub layer: Option<u16>,
    /// View dimension, for cubes or arrays of one layer. `None` gives 2D for one layer, 2D array for several.
    pub dimension: Option<TextureViewDimension>,
    /// Plane. `None` selects the declared planes, and depth for depth-stencil textures.
    pub aspect: Option<Aspect>,
}

impl ViewPart {
    /// The whole declared access.
    pub const WHOLE: Self = Self { mip: None, layer: None, dimension: None, aspect: None };

    /// Selects one mip level.
    pub const fn mip(mip: u8) -> Self {
        Self { mip: Some(mip), ..Self::WHOLE }
    }

    /// Selects the whole access with another view dimension.
    pub const fn as_dimension(dimension: TextureViewDimension) -> Self {
        Self { dimension: Some(dimension), ..Self::WHOLE }
    }

    /// Returns the selected part of `declared`, or `None` if it is outside.
    pub(super) fn of(self, declared: Range, (mips, layers): (u32, u32)) -> Option<Range> {
        let mut range = declared;
        if let Some(mip) = self.mip {
            (range.mip, range.mips) = (mip, 1);
        }
        if let Some(layer) = self.layer {
            (range.layer, range.layers) = (layer, 1);
        }
        let plane = self.aspect.is_none_or(|a| declared.aspect == Aspect::All || declared.aspect == a);
        range.aspect = self.aspect.unwrap_or(declared.aspect);
        let mip = declared.mip_range(mips).contains(&range.mip.into());
        let layer = declared.layer_range(layers).contains(&range.layer.into());
        (mip && layer && plane).then_some(range)
    }
}

/// Texture or buffer of an access.
#[derive(Clone, Debug)]
pub enum BoundResource {
    /// A texture with a view of the accessed part.
    Texture {
        /// Texture of the access.
        texture: wgpu::Texture,
        /// View of the accessed part.
        view: TextureView,
    },
    /// The declared bytes of a buffer.
    Buffer(BoundBuffer),
}

/// A range of a buffer: the bytes that an access declares. By default this is the whole resource, which may be smaller
/// than the buffer.
#[derive(Clone, Debug)]
pub struct BoundBuffer {
    /// Buffer; may be larger than the resource.
    pub buffer: wgpu::Buffer,
    /// Start of the declared range, in bytes.
    pub offset: u64,
    /// Size of the declared range, in bytes.
    pub bytes: u64,
}

impl BoundBuffer {
    /// Returns the declared range as a slice, for vertex and index buffers.
    pub fn slice(&self) -> wgpu::BufferSlice<'_> {
        self.buffer.slice(self.offset..self.offset + self.bytes)
    }
}

impl From<BoundBuffer> for Binding {
    fn from(bound: BoundBuffer) -> Self {
        Self::Buffer { buffer: bound.buffer, offset: bound.offset, bytes: std::num::NonZeroU64::new(bound.bytes) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_must_be_inside_the_declared_range() {
        let declared = Range { mip: 1, mips: 2, layer: 0, layers: u16::MAX, ..Range::ALL };
        let of = |part: ViewPart| part.of(declared, (4, 6));
        assert_eq!(of(ViewPart::WHOLE), Some(declared));
        assert_eq!(of(ViewPart::mip(2)), Some(Range { mip: 2, mips: 1, ..declared }));
        assert_eq!((of(ViewPart::mip(0)), of(ViewPart::mip(3))), (None, None));
        let layer = |layer| ViewPart { layer: Some(layer), ..ViewPart::WHOLE };
        assert_eq!(of(layer(5)), Some(Range { layer: 5, layers: 1, ..declared }));
        assert_eq!(of(layer(6)), None);
    }

    #[test]
    fn a_plane_must_be_declared() {
        let part = ViewPart { aspect: Some(Aspect::Stencil), ..ViewPart::WHOLE };
        let of = |aspect| part.of(Range { aspect, ..Range::ALL }, (1, 1)).map(|r| r.aspect);
        assert_eq!(of(Aspect::All), Some(Aspect::Stencil));
        assert_eq!((of(Aspect::Stencil), of(Aspect::Depth)), (Some(Aspect::Stencil), None));
    }
}
