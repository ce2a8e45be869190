//! Result of an inspection: the values of a texture as a shader reads them, bit for bit.

use crate::device::format::texture_format;
use framegraph::{Aspect, Format, Numeric};

/// Texel values of one part of a texture, top row first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texels {
    /// Format of the texture.
    pub format: Format,
    /// Plane of a depth-stencil texture; `All` for color.
    pub aspect: Aspect,
    /// Width and height in texels.
    pub size: [u32; 2],
    /// Four channels per texel, as bits of 32-bit floats or as integers. Missing channels are 0, missing alpha is 1.
    pub bits: Vec<[u32; 4]>,
}

impl Texels {
    /// Returns the type of the values: float, depth or integer.
    pub fn numeric(&self) -> Numeric {
        match self.format.numeric() {
            Numeric::Depth if self.aspect == Aspect::Stencil || !self.format.has_depth() => Numeric::Uint,
            Numeric::Depth => Numeric::Depth,
            other => other,
        }
    }

    /// Returns the values as floats. sRGB colors are linear; depth and stencil are in the first channel. Integers above
    /// 2²⁴ are rounded.
    pub fn numbers(&self) -> Vec<[f32; 4]> {
        let number: fn(u32) -> f32 = match self.numeric() {
            Numeric::Float | Numeric::Depth => f32::from_bits,
            Numeric::Uint => |bits| bits as f32,
            Numeric::Sint => |bits| bits as i32 as f32,
        };
        self.bits.iter().map(|texel| texel.map(number)).collect()
    }

    /// Returns distances from the camera in meters (`near_m / depth`), for reversed depth with the far plane at
    /// infinity. Infinite for the far plane. `None` if the texels are not depth.
    pub fn distances_m(&self, near_m: f32) -> Option<Vec<f32>> {
        let depth = self.numeric() == Numeric::Depth;
        depth.then(|| self.bits.iter().map(|[depth, ..]| near_m / f32::from_bits(*depth)).collect())
    }

    /// Returns the number of texels with NaN or infinity in the first `channels` channels.
    pub fn non_finite(&self, channels: usize) -> usize {
        let float = matches!(self.numeric(), Numeric::Float | Numeric::Depth);
        // All exponent bits are set in NaN and infinity.
        let off = |bits: &u32| float && bits & 0x7f80_0000 == 0x7f80_0000;
        self.bits.iter().filter(|texel| texel.iter().take(channels).any(off)).count()
    }

    /// Returns the number of channels of the format; 1 for depth or stencil.
    pub fn channels(&self) -> usize {
        if self.format.is_depth_stencil() { 1 } else { texture_format(self.format).components().into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texels(format: Format, aspect: Aspect, bits: [u32; 4]) -> Texels {
        Texels { format, aspect, size: [1, 1], bits: vec![bits] }
    }

    #[test]
    fn bits_are_converted_by_format() {
        let of = |format, aspect, bits| texels(format, aspect, bits).numbers()[0][0];
        assert_eq!(of(Format::Rgba16Float, Aspect::All, [0.5f32.to_bits(), 0, 0, 0]), 0.5);
        assert_eq!(of(Format::R32Uint, Aspect::All, [7, 0, 0, 0]), 7.0);
        assert_eq!(of(Format::R8Sint, Aspect::All, [u32::MAX, 0, 0, 0]), -1.0);
        let both = Format::Depth32FloatStencil8;
        assert_eq!(of(both, Aspect::Stencil, [170, 0, 0, 0]), 170.0);
        assert_eq!(of(both, Aspect::Depth, [0.25f32.to_bits(), 0, 0, 0]), 0.25);
    }

    #[test]
    fn distance_is_near_over_reversed_depth() {
        let depth = |d: f32| texels(Format::Depth32Float, Aspect::All, [d.to_bits(), 0, 0, 0]).distances_m(0.1);
        assert_eq!(depth(1.0), Some(vec![0.1]), "the near plane");
        assert_eq!(depth(0.5), Some(vec![0.2]));
        assert_eq!(depth(0.0), Some(vec![f32::INFINITY]), "nothing was drawn");
        assert_eq!(texels(Format::R32Float, Aspect::All, [0; 4]).distances_m(0.1), None);
    }

    #[test]
    fn non_finite_values_are_found_by_their_bits() {
        let at = |format, bits: u32| texels(format, Aspect::All, [0, bits, 0, 0]).non_finite(2);
        for bits in [0x7fc0_0000, 0xffff_ffff, 0x7f80_0000, 0xff80_0000] {
            assert_eq!(at(Format::Rg32Float, bits), 1);
        }
        assert_eq!((at(Format::Rg32Float, f32::MAX.to_bits()), at(Format::Rg32Uint, u32::MAX)), (0, 0));
        assert_eq!(
            texels(Format::R32Float, Aspect::All, [0, u32::MAX, 0, 0]).non_finite(1),
            0,
            "a missing channel does not count"
        );
    }
}
