//! The shape of a buffer: how many bytes, fixed or following the frame.

use super::extent::Extent;

/// The shape of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct BufferDesc {
    /// How many bytes.
    pub size: BufferSize,
}

/// The size of a buffer.
///
/// ```
/// use framegraph::{BufferSize, Extent, Graph};
///
/// let mut graph = Graph::new();
/// let counters = graph.buffer("counters", 256);
/// // A list of lights for each tile of 16 by 16 texels, whatever the frame's size.
/// let lists = graph.buffer("light lists", BufferSize::per_texel(512, Extent::fraction(16)));
/// # let _ = (counters, lists);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum BufferSize {
    /// So many bytes, not 0.
    Bytes(u64),
    /// So many bytes, not 0, for each texel of an extent: with [`Extent::FRAME`] for each texel of the frame, with
    /// `Extent::fraction(16)` for each tile of 16 by 16 texels.
    PerTexel {
        /// Bytes a texel.
        bytes: u32,
        /// The extent whose texels are counted.
        extent: Extent,
    },
}

impl BufferSize {
    /// `bytes` bytes for each texel of `extent`.
    pub const fn per_texel(bytes: u32, extent: Extent) -> Self {
        Self::PerTexel { bytes, extent }
    }
}

impl From<u64> for BufferSize {
    fn from(bytes: u64) -> Self {
        Self::Bytes(bytes)
    }
}

impl BufferDesc {
    /// The size in bytes for a frame of `frame` texels; saturates.
    #[inline]
    pub const fn bytes(&self, frame: [u32; 2]) -> u64 {
        match self.size {
            BufferSize::Bytes(bytes) => bytes,
            BufferSize::PerTexel { bytes, extent } => {
                let [width, height] = extent.texels(frame);
                (width as u64 * height as u64).saturating_mul(bytes as u64)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_follow_the_frame() {
        let size = |size| BufferDesc { size }.bytes([1920, 1080]);
        assert_eq!(size(BufferSize::Bytes(7)), 7);
        assert_eq!(size(BufferSize::per_texel(4, Extent::FRAME)), 1920 * 1080 * 4);
        // 1080 texels are 67 tiles and a half of 16: the last row of tiles is counted too.
        assert_eq!(size(BufferSize::per_texel(8, Extent::fraction(16))), 120 * 68 * 8);
        let huge = Extent::absolute(u32::MAX, u32::MAX);
        assert_eq!(size(BufferSize::per_texel(u32::MAX, huge)), u64::MAX);
    }
}
