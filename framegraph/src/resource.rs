//! What is declared of a resource: shape, kind, and what it holds on entry and must hold on exit.

mod buffer;
mod extent;

use crate::barrier::{Stages, State};
use crate::format::Format;
use crate::id::{ResourceId, Span, VersionId};
use crate::words::words;
pub use buffer::{BufferDesc, BufferSize};
pub use extent::Extent;

/// How the texels are arranged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Dimension {
    /// Two-dimensional, possibly an array of layers.
    #[default]
    D2,
    /// Three-dimensional: `layers` is the depth. A level is one subresource, whatever its depth: it is sampled, stored and
    /// copied as a whole, and attached only where it is one slice.
    D3,
}

/// The shape of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct TextureDesc {
    /// Width and height of mip 0.
    pub extent: Extent,
    /// What a texel holds.
    pub format: Format,
    /// Levels, at least 1; [`TextureDesc::ALL_MIPS`] asks for the full chain down to 1×1.
    pub mips: u8,
    /// Samples per texel: 1, 2, 4, 8 or 16.
    pub samples: u8,
    /// Array layers (6 per cube), or the depth of a three-dimensional texture; at least 1.
    pub layers: u16,
    /// Two or three dimensions.
    pub dimension: Dimension,
}

impl TextureDesc {
    /// As many levels as the extent allows: ⌊log₂ max(width, height)⌋ + 1.
    pub const ALL_MIPS: u8 = 0;

    /// A two-dimensional texture of one level, one layer, one sample.
    pub const fn new(extent: Extent, format: Format) -> Self {
        Self { extent, format, mips: 1, samples: 1, layers: 1, dimension: Dimension::D2 }
    }

    /// The same with another format.
    pub const fn format(mut self, format: Format) -> Self {
        self.format = format;
        self
    }

    /// The same with another size.
    pub const fn extent(mut self, extent: Extent) -> Self {
        self.extent = extent;
        self
    }

    /// The same with `samples` samples per texel.
    pub const fn samples(mut self, samples: u8) -> Self {
        self.samples = samples;
        self
    }

    /// The same with `mips` levels.
    pub const fn mips(mut self, mips: u8) -> Self {
        self.mips = mips;
        self
    }

    /// The same with `layers` array layers.
    pub const fn layers(mut self, layers: u16) -> Self {
        self.layers = layers;
        self
    }

    /// Levels for a frame of `frame` texels, with [`Self::ALL_MIPS`] counted out.
    pub const fn mip_count(&self, frame: [u32; 2]) -> u32 {
        if self.mips != Self::ALL_MIPS {
            return self.mips as u32;
        }
        let [w, h] = self.extent.texels(frame);
        let side = if w > h { w } else { h };
        if side == 0 { 1 } else { side.ilog2() + 1 }
    }

    /// Width and height of level `mip`, in texels: halved per level, never below 1.
    pub const fn mip_extent(&self, frame: [u32; 2], mip: u32) -> [u32; 2] {
        let [w, h] = self.extent.texels(frame);
        [halved(w, mip), halved(h, mip)]
    }

    /// How many layers are tracked as subresources: the depth of a three-dimensional texture is not.
    pub const fn tracked_layers(&self) -> u32 {
        match self.dimension {
            Dimension::D2 => self.layers as u32,
            Dimension::D3 => 1,
        }
    }

    /// Bytes of all levels, layers, planes and samples without any padding; saturates.
    pub const fn bytes(&self, frame: [u32; 2]) -> u64 {
        if self.mips == 1 && !self.format.is_compressed() {
            let [w, h] = self.extent.texels(frame);
            let texel = self.format.block_bytes() as u64 * self.samples as u64;
            return (w as u64 * h as u64).saturating_mul(texel * self.layers as u64);
        }
        let mut total = 0u64;
        let mut mip = 0;
        let count = self.mip_count(frame);
        while mip < count {
            let mut layer = self.mip_bytes(frame, mip);
            let depth = match self.dimension {
                Dimension::D2 => self.layers as u32,
                Dimension::D3 => halved(self.layers as u32, mip),
            };
            layer = layer.saturating_mul(depth as u64);
            total = total.saturating_add(layer);
            mip += 1;
        }
        total
    }

    /// Bytes of one layer of level `mip`, all planes and samples, without padding; saturates.
    pub const fn mip_bytes(&self, frame: [u32; 2], mip: u32) -> u64 {
        let [w, h] = self.mip_extent(frame, mip);
        let (bw, bh) = self.format.block_texels();
        let blocks = (w.div_ceil(bw) as u64).saturating_mul(h.div_ceil(bh) as u64);
        blocks.saturating_mul(self.format.block_bytes() as u64).saturating_mul(self.samples as u64)
    }
}

/// A side of level `mip`: never below 1.
#[inline]
pub(crate) const fn halved(side: u32, mip: u32) -> u32 {
    let h = if mip < 32 { side >> mip } else { 0 };
    if h == 0 && side != 0 { 1 } else { h }
}

/// The shape of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Desc {
    /// A texture of that shape.
    Texture(TextureDesc),
    /// A buffer of that size.
    Buffer(BufferDesc),
}

impl Desc {
    /// The texture's shape, or `None` for a buffer.
    pub const fn texture(&self) -> Option<&TextureDesc> {
        match self {
            Self::Texture(t) => Some(t),
            Self::Buffer(_) => None,
        }
    }

    /// Bytes without padding for a frame of `frame` texels.
    pub const fn bytes(&self, frame: [u32; 2]) -> u64 {
        match self {
            Self::Texture(t) => t.bytes(frame),
            Self::Buffer(b) => b.bytes(frame),
        }
    }

    /// Levels × layers × planes: how many parts are tracked separately; of a buffer 1, as long as no access names bytes of it.
    #[inline]
    pub const fn subresources(&self, frame: [u32; 2]) -> u32 {
        match self {
            Self::Texture(t) => t.mip_count(frame) * t.tracked_layers() * t.format.planes(),
            Self::Buffer(_) => 1,
        }
    }
}

/// What an imported resource holds when the frame begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Entry {
    /// Contents that passes may read.
    Defined,
    /// Nothing: the first access must write (a swapchain image).
    Undefined,
    /// As its owner left it, for devices that are told about transitions: contents that passes may read, unless the state
    /// is `Undefined`.
    Left {
        /// The state that all of it is in.
        state: State,
        /// The stages of the owner's work that the first use waits for.
        stages: Stages,
    },
}

impl Entry {
    /// Whether it holds contents that passes may read.
    #[inline]
    pub const fn is_defined(self) -> bool {
        match self {
            Self::Defined => true,
            Self::Undefined => false,
            Self::Left { state, .. } => !matches!(state, State::Undefined),
        }
    }
}

/// What must be true of an imported resource when the frame ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Exit {
    /// Its contents are needed afterwards: passes that write it are kept.
    Keep,
    /// Its contents are not needed afterwards.
    Discard,
}

/// Where a resource comes from and how long it lives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Made for this frame by the graph; shares memory with others.
    Transient,
    /// Owned outside of the graph.
    Imported {
        /// What it holds on entry.
        entry: Entry,
        /// What must survive.
        exit: Exit,
    },
    /// The image of a history that this frame writes.
    HistoryCurrent {
        /// How many earlier frames can be read: the ring has one image more.
        frames: u8,
    },
    /// The image of a history as it was `age` frames ago; read only.
    HistoryPrevious {
        /// The image that this frame writes.
        current: ResourceId,
        /// Frames back, at least 1.
        age: u8,
    },
}

words! {
    Kind: Transient "transient", Imported "imported", HistoryCurrent "history", HistoryPrevious "previous"
}

impl Kind {
    /// Whether passes may read it before any pass of this frame wrote it.
    #[inline]
    pub const fn defined_on_entry(self) -> bool {
        match self {
            Self::Imported { entry, .. } => entry.is_defined(),
            Self::HistoryPrevious { .. } => true,
            Self::Transient | Self::HistoryCurrent { .. } => false,
        }
    }

    /// Whether its contents are needed after the frame, so that writing it keeps a pass.
    #[inline]
    pub const fn kept_on_exit(self) -> bool {
        matches!(self, Self::Imported { exit: Exit::Keep, .. } | Self::HistoryCurrent { .. })
    }
}

/// One row of [`Graph::resources`](crate::graph::Tables::resources).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resource {
    /// Its full name in the graph's text.
    pub name: Span,
    /// Its newest version: the only one that may be used next.
    pub current: VersionId,
    /// Where it comes from.
    pub kind: Kind,
    /// Its shape: a texture's extent, format, levels and so on, or a buffer's bytes.
    pub desc: Desc,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relative_extents_round_up_and_never_vanish() {
        assert_eq!(Extent::FRAME.texels([1920, 1080]), [1920, 1080]);
        assert_eq!(Extent::fraction(2).texels([1921, 1]), [961, 1]);
        // Filament's half-resolution ambient occlusion at 1080p: rounded up to 16 texels, 960 × 544.
        assert_eq!(Extent::Relative { num: 1, den: 2, align: 16 }.texels([1920, 1080]), [960, 544]);
        assert_eq!(Extent::fraction(8).texels([3, 3]), [1, 1]);
    }

    #[test]
    fn a_full_chain_ends_at_one_texel() {
        let d = TextureDesc::new(Extent::absolute(1, 777), Format::R8Unorm).mips(TextureDesc::ALL_MIPS);
        assert_eq!(d.mip_count([0, 0]), 10);
        assert_eq!(d.mip_extent([0, 0], 9), [1, 1]);
        assert_eq!(d.mip_extent([0, 0], 40), [1, 1]);
    }

    #[test]
    fn bytes_count_levels_layers_and_samples() {
        let d = TextureDesc::new(Extent::absolute(4, 4), Format::Rgba8Unorm).mips(3).layers(2);
        assert_eq!(d.bytes([0, 0]), 2 * 4 * (16 + 4 + 1));
        let ms = TextureDesc::new(Extent::absolute(4, 4), Format::Rgba16Float).samples(4);
        assert_eq!(ms.bytes([0, 0]), 16 * 8 * 4);
        let bc = TextureDesc::new(Extent::absolute(5, 5), Format::Bc1RgbaUnorm);
        assert_eq!(bc.bytes([0, 0]), 4 * 8);
        let huge = TextureDesc::new(Extent::absolute(u32::MAX, u32::MAX), Format::Rgba32Float).samples(16);
        assert_eq!(huge.bytes([0, 0]), u64::MAX);
    }
}
