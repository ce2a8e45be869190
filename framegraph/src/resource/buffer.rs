//! Descriptor of a buffer, with a fixed size or one relative to the frame.

use super::extent::Extent;

/// Descriptor of a buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub struct BufferDesc {
    /// Size of the buffer.
    pub size: BufferSize,
}

/// Size of a buffer.
///
/// ```
/// use framegraph::{BufferSize, Extent, Graph};
///
/// let mut graph = Graph::new();
/// let counters = graph.buffer("counters", 256);
/// // A light list of 512 bytes for each tile of 16×16 texels, at any frame size.
/// let lists = graph.buffer("light lists", BufferSize::per_texel(512, Extent::fraction(16)));
/// # let _ = (counters, lists);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "files", derive(serde::Serialize, serde::Deserialize))]
pub enum BufferSize {
    /// Fixed size in bytes, not 0.
    Bytes(u64),
    /// Bytes per texel of an extent. [`Extent::FRAME`] counts the texels of the frame; `Extent::fraction(16)` counts
    /// tiles of 16×16 texels.
    PerTexel {
        /// Bytes per texel, not 0.
        bytes: u32,
        /// The extent whose texels are counted.
        extent: Extent,
    },
}

impl BufferSize {
    /// Returns a size of `bytes` bytes per texel of `extent`.
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
    /// Size in bytes for a frame of `frame` texels. Saturates.
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
        // 1080 texels are 67.5 tiles of 16: the partial last row counts as a full one.
        assert_eq!(size(BufferSize::per_texel(8, Extent::fraction(16))), 120 * 68 * 8);
        let huge = Extent::absolute(u32::MAX, u32::MAX);
        assert_eq!(size(BufferSize::per_texel(u32::MAX, huge)), u64::MAX);
    }
}
