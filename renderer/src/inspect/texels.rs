//! What an inspection returns: the numbers of a texture as a shader reads them, bit for bit.

use framegraph::{Aspect, Format, Numeric};

/// The texels of one part of a texture, rows from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Texels {
    /// What the texture holds.
    pub format: Format,
    /// Which plane of a depth-stencil texture; `All` for color.
    pub aspect: Aspect,
    /// Width and height.
    pub size: [u32; 2],
    /// Four channels a texel: the bits of a 32-bit float, or an integer. Missing channels are 0, missing alpha is 1.
    pub bits: Vec<[u32; 4]>,
}

impl Texels {
    /// How the bits are to be read: floats (depth among them), or integers.
    pub fn numeric(&self) -> Numeric {
        match self.format.numeric() {
            Numeric::Depth if self.aspect == Aspect::Stencil || !self.format.has_depth() => Numeric::Uint,
            Numeric::Depth => Numeric::Depth,
            other => other,
        }
    }

    /// The numbers: linear light for color, whatever the texture's transfer function; depth and stencil in the first
    /// channel. Integers above 2²⁴ are rounded.
    pub fn numbers(&self) -> Vec<[f32; 4]> {
        let number: fn(u32) -> f32 = match self.numeric() {
            Numeric::Float | Numeric::Depth => f32::from_bits,
            Numeric::Uint => |bits| bits as f32,
            Numeric::Sint => |bits| bits as i32 as f32,
        };
        self.bits.iter().map(|texel| texel.map(number)).collect()
    }

    /// Distances from the camera in meters, of reversed depth with the far plane at infinity: `near_m / depth`, which is
    /// infinite where nothing was drawn. `None` when the texels are no depths.
    pub fn distances_m(&self, near_m: f32) -> Option<Vec<f32>> {
        let depth = self.numeric() == Numeric::Depth;
        depth.then(|| self.bits.iter().map(|[depth, ..]| near_m / f32::from_bits(*depth)).collect())
    }

    /// Texels of which one of the `channels` first channels is NaN or infinite, found by bits.
    pub fn non_finite(&self, channels: usize) -> usize {
        let float = matches!(self.numeric(), Numeric::Float | Numeric::Depth);
        // All exponent bits set.
        let off = |bits: &u32| float && bits & 0x7f80_0000 == 0x7f80_0000;
        self.bits.iter().filter(|texel| texel.iter().take(channels).any(off)).count()
    }

    /// Channels that the format has.
    pub fn channels(&self) -> usize {
        channels(self.format)
    }
}

/// Channels of a format; depth-stencil planes have one.
fn channels(format: Format) -> usize {
    use Format::*;
    match format {
        R8Unorm | R8Snorm | R8Uint | R8Sint | R16Uint | R16Sint | R16Float | R32Uint | R32Sint | R32Float
        | Bc4RUnorm => 1,
        Rg8Unorm | Rg8Snorm | Rg8Uint | Rg8Sint | Rg16Uint | Rg16Sint | Rg16Float | Rg32Uint | Rg32Sint | Rg32Float
        | Bc5RgUnorm => 2,
        Rgb9e5Ufloat | Rg11b10Ufloat | Bc6hRgbUfloat | Etc2Rgb8Unorm => 3,
        _ if format.is_depth_stencil() => 1,
        _ => 4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texels(format: Format, aspect: Aspect, bits: [u32; 4]) -> Texels {
        Texels { format, aspect, size: [1, 1], bits: vec![bits] }
    }

    #[test]
    fn bits_become_numbers_by_the_kind_of_format() {
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
    fn bad_numbers_are_found_by_their_bits() {
        let at = |format, bits: u32| texels(format, Aspect::All, [0, bits, 0, 0]).non_finite(2);
        for bits in [0x7fc0_0000, 0xffff_ffff, 0x7f80_0000, 0xff80_0000] {
            assert_eq!(at(Format::Rg32Float, bits), 1);
        }
        assert_eq!((at(Format::Rg32Float, f32::MAX.to_bits()), at(Format::Rg32Uint, u32::MAX)), (0, 0));
        assert_eq!(texels(Format::R32Float, Aspect::All, [0, u32::MAX, 0, 0]).non_finite(1), 0, "a channel it lacks");
    }
}
