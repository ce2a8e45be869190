//! The texture properties other than its size, packed into one word for fast comparison.

use crate::format::Format;
use crate::resource::{Dimension, TextureDesc};

/// From the lowest byte up: format, levels, samples, two bytes of layers, dimension.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Layout(u64);

const FORMAT: u64 = 0xFF;
const MIPS: u32 = 8;
const SAMPLES: u32 = 16;
const LAYERS: u32 = 24;
const VOLUME: u64 = 1 << 40;

impl Layout {
    /// The layout of every buffer.
    pub(crate) const BUFFER: Self = Self(1 << 63 | 1 << MIPS | 1 << SAMPLES | FORMAT);

    /// Returns the layout of a texture with `mips` levels, because `desc` may request the full chain.
    #[inline]
    pub(crate) fn of_texture(desc: &TextureDesc, mips: u8) -> Self {
        let volume = if desc.dimension == Dimension::D3 { VOLUME } else { 0 };
        let counts = u64::from(mips) << MIPS | u64::from(desc.samples) << SAMPLES | u64::from(desc.layers) << LAYERS;
        Self(desc.format as u64 | counts | volume)
    }

    /// Returns the layout of a texture with one level, one layer and one sample.
    #[inline]
    pub(crate) const fn flat(format: Format) -> Self {
        Self(format as u64 | 1 << MIPS | 1 << SAMPLES | 1 << LAYERS)
    }

    /// Number of levels; 1 for a buffer.
    #[inline]
    pub(crate) const fn mips(self) -> u8 {
        (self.0 >> MIPS) as u8
    }

    /// Number of samples per texel; 1 for a buffer.
    #[inline]
    pub(crate) const fn samples(self) -> u8 {
        (self.0 >> SAMPLES) as u8
    }

    /// Index of the format; 255 for a buffer.
    #[inline]
    pub(crate) const fn format(self) -> u8 {
        self.0 as u8
    }

    /// Returns the layout with another format.
    #[inline]
    pub(crate) const fn with_format(self, format: Format) -> Self {
        Self(self.0 & !FORMAT | format as u64)
    }

    /// Returns the layout with a format without the sRGB transfer function.
    #[inline]
    pub(crate) const fn linear(self) -> Self {
        Self(self.0 & !FORMAT | LINEAR[self.format() as usize] as u64)
    }

    /// The packed word.
    #[inline]
    pub(crate) const fn bits(self) -> u64 {
        self.0
    }
}

/// Index of each format's linear twin. Has 256 entries, so that a byte never exceeds the range.
const LINEAR: [u8; 256] = {
    let mut table = [0; 256];
    let mut at = 0;
    while at < Format::ALL.len() {
        table[at] = Format::ALL[at].without_srgb() as u8;
        at += 1;
    }
    table
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resource::Extent;

    #[test]
    fn every_field_counts() {
        let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb);
        let layout = |desc: &TextureDesc| Layout::of_texture(desc, desc.mips);
        let plain = layout(&desc);
        assert_eq!(plain, Layout::flat(desc.format));
        assert_eq!((plain.mips(), plain.samples()), (1, 1));
        let volume = TextureDesc { dimension: Dimension::D3, ..desc };
        let others = [desc.mips(255), desc.samples(16), desc.layers(u16::MAX), volume, desc.format(Format::R8Unorm)];
        for (index, other) in others.iter().enumerate() {
            assert_ne!(layout(other), plain, "{index}");
            assert_ne!(layout(other), Layout::BUFFER, "{index}");
            assert_eq!(layout(other).with_format(desc.format) == plain, index == 4, "{index}");
        }
        assert_eq!(plain.linear(), Layout::flat(Format::Rgba8Unorm));
        assert_eq!(plain.format(), Format::Rgba8UnormSrgb as u8);
    }
}
