//! Descriptions of resources: shape, origin, and contents at the start and the end of the frame.

mod buffer;
mod extent;

use crate::barrier::{Stages, State};
use crate::enum_names::enum_names;
use crate::format::Format;
use crate::id::{ResourceId, Span, VersionId};
pub use buffer::{BufferDesc, BufferSize};
pub use extent::Extent;

/// Dimensionality of a texture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Dimension {
    /// Two-dimensional, possibly an array of layers.
    #[default]
    D2,
    /// Three-dimensional; `layers` is the depth. Each level is one subresource: it is sampled, stored and copied as a
    /// whole. It can be attached only if it has a single slice.
    D3,
}

/// Descriptor of a texture.
///
/// ```
/// use framegraph::{Extent, Format, TextureDesc};
///
/// let bloom = TextureDesc::new(Extent::fraction(2), Format::Rgba16Float).mips(TextureDesc::ALL_MIPS);
/// assert_eq!(bloom.mip_extent([1920, 1080], 0), [960, 540]);
/// assert_eq!(bloom.mip_count([1920, 1080]), 10);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct TextureDesc {
    /// Width and height of mip 0.
    pub extent: Extent,
    /// Format of the texels.
    pub format: Format,
    /// Number of mip levels, at least 1; [`TextureDesc::ALL_MIPS`] requests the full chain down to 1×1.
    pub mips: u8,
    /// Samples per texel: 1, 2, 4, 8 or 16.
    pub samples: u8,
    /// Number of array layers (6 per cube), or the depth of a three-dimensional texture; at least 1.
    pub layers: u16,
    /// Two or three dimensions.
    pub dimension: Dimension,
}

impl TextureDesc {
    /// Requests the full mip chain: ⌊log₂ max(width, height)⌋ + 1 levels.
    pub const ALL_MIPS: u8 = 0;

    /// Creates the descriptor of a two-dimensional texture with one level, one layer and one sample.
    pub const fn new(extent: Extent, format: Format) -> Self {
        Self { extent, format, mips: 1, samples: 1, layers: 1, dimension: Dimension::D2 }
    }

    /// Sets the format.
    pub const fn format(mut self, format: Format) -> Self {
        self.format = format;
        self
    }

    /// Sets the size of level 0.
    pub const fn extent(mut self, extent: Extent) -> Self {
        self.extent = extent;
        self
    }

    /// Sets the number of samples per texel.
    pub const fn samples(mut self, samples: u8) -> Self {
        self.samples = samples;
        self
    }

    /// Sets the number of mip levels.
    pub const fn mips(mut self, mips: u8) -> Self {
        self.mips = mips;
        self
    }

    /// Sets the number of array layers.
    pub const fn layers(mut self, layers: u16) -> Self {
        self.layers = layers;
        self
    }

    /// Returns the number of mip levels for a frame of `frame` texels, with [`Self::ALL_MIPS`] evaluated.
    pub const fn mip_count(&self, frame: [u32; 2]) -> u32 {
        if self.mips != Self::ALL_MIPS {
            return self.mips as u32;
        }
        let [w, h] = self.extent.texels(frame);
        let side = if w > h { w } else { h };
        if side == 0 { 1 } else { side.ilog2() + 1 }
    }

    /// Returns width and height of level `mip` in texels: halved per level, at least 1.
    pub const fn mip_extent(&self, frame: [u32; 2], mip: u32) -> [u32; 2] {
        let [w, h] = self.extent.texels(frame);
        [halved(w, mip), halved(h, mip)]
    }

    /// Number of layers that are tracked as subresources; 1 for a three-dimensional texture.
    pub const fn tracked_layers(&self) -> u32 {
        match self.dimension {
            Dimension::D2 => self.layers as u32,
            Dimension::D3 => 1,
        }
    }

    /// Number of layers, or of slices of level `mip` of a three-dimensional texture: the range of an attachment's layer.
    pub const fn slices(&self, mip: u32) -> u32 {
        match self.dimension {
            Dimension::D2 => self.layers as u32,
            Dimension::D3 => halved(self.layers as u32, mip),
        }
    }

    /// Size in bytes of all levels, layers, planes and samples, without padding. Saturates.
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

    /// Size in bytes of one layer of level `mip`, with all planes and samples, without padding. Saturates.
    pub const fn mip_bytes(&self, frame: [u32; 2], mip: u32) -> u64 {
        let [w, h] = self.mip_extent(frame, mip);
        let (bw, bh) = self.format.block_texels();
        let blocks = (w.div_ceil(bw) as u64).saturating_mul(h.div_ceil(bh) as u64);
        blocks.saturating_mul(self.format.block_bytes() as u64).saturating_mul(self.samples as u64)
    }
}

/// Returns the length of a side at level `mip`, at least 1 unless `side` is 0.
#[inline]
pub(crate) const fn halved(side: u32, mip: u32) -> u32 {
    let h = if mip < 32 { side >> mip } else { 0 };
    if h == 0 && side != 0 { 1 } else { h }
}

/// Descriptor of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Desc {
    /// A texture.
    Texture(TextureDesc),
    /// A buffer.
    Buffer(BufferDesc),
}

impl Desc {
    /// Returns the texture descriptor, or `None` for a buffer.
    pub const fn texture(&self) -> Option<&TextureDesc> {
        match self {
            Self::Texture(t) => Some(t),
            Self::Buffer(_) => None,
        }
    }

    /// Size in bytes for a frame of `frame` texels, without padding. Saturates.
    pub const fn bytes(&self, frame: [u32; 2]) -> u64 {
        match self {
            Self::Texture(t) => t.bytes(frame),
            Self::Buffer(b) => b.bytes(frame),
        }
    }

    /// Number of subresources: levels × layers × planes. 1 for a buffer, as long as no access names a byte range.
    #[inline]
    pub const fn subresources(&self, frame: [u32; 2]) -> u32 {
        match self {
            Self::Texture(t) => t.mip_count(frame) * t.tracked_layers() * t.format.planes(),
            Self::Buffer(_) => 1,
        }
    }
}

/// Contents of an imported resource at the start of the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Entry {
    /// Defined contents that passes may read.
    Defined,
    /// Undefined contents: the first access must write. Typical for a swapchain image.
    Undefined,
    /// An explicit state, for devices with explicit barriers. Passes may read the contents unless the state is
    /// `Undefined`.
    Left {
        /// State of the whole resource.
        state: State,
        /// Pipeline stages of the owner's work that the first use waits for.
        stages: Stages,
    },
}

impl Entry {
    /// Returns `true` if passes may read the contents.
    #[inline]
    pub const fn is_defined(self) -> bool {
        match self {
            Self::Defined => true,
            Self::Undefined => false,
            Self::Left { state, .. } => !matches!(state, State::Undefined),
        }
    }
}

/// Requirement on an imported resource at the end of the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum Exit {
    /// The contents are used after the frame, so the passes that write them are kept.
    Keep,
    /// The contents are not used after the frame.
    Discard,
}

/// Origin and lifetime of a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Created by the graph for this frame; may share memory with other resources.
    Transient,
    /// Owned by the caller.
    Imported {
        /// Contents at the start of the frame.
        entry: Entry,
        /// Requirement at the end of the frame.
        exit: Exit,
    },
    /// The image of a history that this frame writes.
    HistoryCurrent {
        /// Number of earlier frames that stay readable. The ring has one image more.
        frames: u8,
    },
    /// The image of a history as it was `age` frames ago; read-only.
    HistoryPrevious {
        /// The image that this frame writes.
        current: ResourceId,
        /// Age in frames, at least 1.
        age: u8,
    },
}

enum_names! {
    Kind: Transient "transient", Imported "imported", HistoryCurrent "history", HistoryPrevious "previous"
}

impl Kind {
    /// Returns `true` if passes may read the resource before a pass of this frame has written it.
    #[inline]
    pub const fn defined_on_entry(self) -> bool {
        match self {
            Self::Imported { entry, .. } => entry.is_defined(),
            Self::HistoryPrevious { .. } => true,
            Self::Transient | Self::HistoryCurrent { .. } => false,
        }
    }

    /// Returns `true` if the contents are used after the frame, so that passes writing them are kept.
    #[inline]
    pub const fn kept_on_exit(self) -> bool {
        matches!(self, Self::Imported { exit: Exit::Keep, .. } | Self::HistoryCurrent { .. })
    }
}

/// One row of [`Graph::resources`](crate::graph::Tables::resources).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Resource {
    /// Full name, as a span of the graph's text.
    pub name: Span,
    /// The newest version; only its handle may be used for further accesses.
    pub current: VersionId,
    /// Origin and lifetime.
    pub kind: Kind,
    /// Descriptor: a texture's extent, format and levels, or a buffer's size.
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
