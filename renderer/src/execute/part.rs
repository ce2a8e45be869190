//! What a look-up takes and returns: parts of accesses, and what stands behind them.

use crate::pipelines::bind_groups::Binding;
use framegraph::{Aspect, Range};
use wgpu::{TextureView, TextureViewDimension};

/// The image of a history as an earlier frame left it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HistoryImage {
    /// It holds what that frame wrote. False on the first frame, after a reset, after more frames without the history than
    /// [`ExecutorOptions::max_age`](crate::ExecutorOptions::max_age), and after a change of its format, layers, samples or
    /// number of frames: it holds zeros then.
    pub valid: bool,
    /// How many times the [`Frame`](crate::Frame) was executed without writing the history since it last did; 0 where the
    /// frame before wrote it. What has no use for a picture that is older than the last one rejects it by this.
    pub missed: u64,
    /// Width and height in texels. A change of size alone keeps earlier images as they were written, so this is the size of
    /// that frame, not of this one; 0 where the history has no images. An earlier image that a pass attaches is not
    /// kept then, nor one that lacks a mip level which a pass names; a pass that samples all levels gets those that there are.
    pub texels: [u32; 2],
}

/// A part of what an access declares, and how shaders see it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ViewPart {
    /// One level, counted from the texture's first; all that were declared by default.
    pub mip: Option<u8>,
    /// One layer, counted from the texture's first; all that were declared by default.
    pub layer: Option<u16>,
    /// A cube, or an array of one layer; by default one layer is two-dimensional and several are an array.
    pub dimension: Option<TextureViewDimension>,
    /// One plane; by default what was declared, and of depth with stencil the depth.
    pub aspect: Option<Aspect>,
}

impl ViewPart {
    /// All that was declared.
    pub const WHOLE: Self = Self { mip: None, layer: None, dimension: None, aspect: None };

    /// One mip level of what was declared.
    pub const fn mip(mip: u8) -> Self {
        Self { mip: Some(mip), ..Self::WHOLE }
    }

    /// Bound by shaders as another dimension.
    pub const fn as_dimension(dimension: TextureViewDimension) -> Self {
        Self { dimension: Some(dimension), ..Self::WHOLE }
    }

    /// The part of `declared`; `None` when it lies outside.
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

/// What stands behind an access.
#[derive(Clone, Debug)]
pub enum BoundResource {
    /// A texture, and the view of the accessed part.
    Texture {
        /// The texture behind the access.
        texture: wgpu::Texture,
        /// A view of the accessed part.
        view: TextureView,
    },
    /// The declared bytes of a buffer.
    Buffer(BoundBuffer),
}

/// The bytes of a buffer that an access declares: all of the resource, which may be less than the buffer has, or those that
/// it names.
#[derive(Clone, Debug)]
pub struct BoundBuffer {
    /// The buffer, which may be longer than the resource.
    pub buffer: wgpu::Buffer,
    /// Bytes in front of those that are declared.
    pub offset: u64,
    /// How many bytes are declared.
    pub bytes: u64,
}

impl BoundBuffer {
    /// The declared bytes, for vertices and indices.
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
    fn a_part_lies_inside_of_what_was_declared() {
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
    fn a_plane_is_one_of_the_declared_ones() {
        let part = ViewPart { aspect: Some(Aspect::Stencil), ..ViewPart::WHOLE };
        let of = |aspect| part.of(Range { aspect, ..Range::ALL }, (1, 1)).map(|r| r.aspect);
        assert_eq!(of(Aspect::All), Some(Aspect::Stencil));
        assert_eq!((of(Aspect::Stencil), of(Aspect::Depth)), (Some(Aspect::Stencil), None));
    }
}
