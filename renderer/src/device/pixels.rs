//! Conversion of texel bytes to linear RGBA, 8-bit sRGB, or depth, for every format that can be copied.

use framegraph::{Aspect, Format};
use half::f16;

/// Pixels read back from the GPU, in rows without padding, top row first.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pixels {
    /// Format of the texels.
    pub format: Format,
    /// Plane; `All` for color.
    pub aspect: Aspect,
    /// Width and height in texels.
    pub texels: [u32; 2],
    /// Texel data: rows from top to bottom, without padding.
    pub bytes: Vec<u8>,
}

impl Pixels {
    /// Returns the size of one texel in bytes.
    pub fn texel_bytes(&self) -> usize {
        let count = self.texels[0] as usize * self.texels[1] as usize;
        self.bytes.len().checked_div(count).unwrap_or(0)
    }

    /// Returns the bytes of the texel at column `x` and row `y`; `None` outside of the image.
    pub fn at(&self, x: u32, y: u32) -> Option<&[u8]> {
        let [width, height] = self.texels;
        let (index, bytes) = (y as usize * width as usize + x as usize, self.texel_bytes());
        (x < width && y < height).then(|| &self.bytes[index * bytes..(index + 1) * bytes])
    }

    /// Returns red, green, blue and alpha of every texel as floats. sRGB formats are decoded to linear. Integers are
    /// converted to floats without scaling. Missing channels are 0, missing alpha is 1. Depth and stencil are returned
    /// in the red channel.
    pub fn rgba(&self) -> Vec<[f32; 4]> {
        let bytes = self.texel_bytes().max(1);
        self.bytes.chunks_exact(bytes).map(|texel| rgba_of(self.format, self.aspect, texel)).collect()
    }

    /// Returns 8-bit RGBA for display, four bytes per texel. Normalized 8-bit formats are returned unchanged in RGBA
    /// order. Other formats are clamped to 0…1 and encoded with the sRGB transfer function; alpha stays linear.
    pub fn rgba8(&self) -> Vec<u8> {
        match self.format {
            Format::Rgba8Unorm | Format::Rgba8UnormSrgb => self.bytes.clone(),
            Format::Bgra8Unorm | Format::Bgra8UnormSrgb => {
                self.bytes.chunks_exact(4).flat_map(|t| [t[2], t[1], t[0], t[3]]).collect()
            }
            Format::R8Unorm => self.bytes.iter().flat_map(|t| [*t, 0, 0, 255]).collect(),
            Format::Rg8Unorm => self.bytes.chunks_exact(2).flat_map(|t| [t[0], t[1], 0, 255]).collect(),
            _ => self.rgba().into_iter().flat_map(code).collect(),
        }
    }

    /// Returns the depth of every texel, 0…1. `None` if the format has no depth, or the stencil plane was read.
    pub fn depth(&self) -> Option<Vec<f32>> {
        let depth = self.format.has_depth() && self.aspect != Aspect::Stencil;
        depth.then(|| self.rgba().into_iter().map(|[depth, ..]| depth).collect())
    }
}

/// Decodes an sRGB value to linear light, both 0…1 (IEC 61966-2-1).
fn linear_from_srgb(code: f32) -> f32 {
    if code <= 0.040_45 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) }
}

/// Encodes linear light as sRGB, both 0…1 (IEC 61966-2-1).
pub(crate) fn srgb_from_linear(light: f32) -> f32 {
    if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

fn code([r, g, b, a]: [f32; 4]) -> [u8; 4] {
    // NaN becomes 0: `clamp` keeps it, and the cast to `u8` turns it into 0.
    let quantized = |x: f32| (x.clamp(0.0, 1.0) * 255.0).round() as u8;
    let encoded = |x: f32| quantized(srgb_from_linear(x.clamp(0.0, 1.0)));
    [encoded(r), encoded(g), encoded(b), quantized(a)]
}

/// Type of the channels of an unpacked format.
#[derive(Clone, Copy)]
enum Channel {
    Unorm8,
    Snorm8,
    Uint8,
    Sint8,
    Uint16,
    Sint16,
    Float16,
    Uint32,
    Sint32,
    Float32,
}

impl Channel {
    const fn bytes(self) -> usize {
        match self {
            Self::Unorm8 | Self::Snorm8 | Self::Uint8 | Self::Sint8 => 1,
            Self::Uint16 | Self::Sint16 | Self::Float16 => 2,
            Self::Uint32 | Self::Sint32 | Self::Float32 => 4,
        }
    }

    fn value(self, b: &[u8]) -> f32 {
        let two = || [b[0], b[1]];
        let four = || [b[0], b[1], b[2], b[3]];
        match self {
            Self::Unorm8 => f32::from(b[0]) / 255.0,
            Self::Snorm8 => (f32::from(b[0] as i8) / 127.0).max(-1.0),
            Self::Uint8 => f32::from(b[0]),
            Self::Sint8 => f32::from(b[0] as i8),
            Self::Uint16 => f32::from(u16::from_le_bytes(two())),
            Self::Sint16 => f32::from(i16::from_le_bytes(two())),
            Self::Float16 => f16::from_le_bytes(two()).to_f32(),
            Self::Uint32 => u32::from_le_bytes(four()) as f32,
            Self::Sint32 => i32::from_le_bytes(four()) as f32,
            Self::Float32 => f32::from_le_bytes(four()),
        }
    }
}

/// Returns the channel type of an unpacked format; `None` for packed, depth and compressed formats.
const fn channel(format: Format) -> Option<Channel> {
    use Format::*;
    Some(match format {
        R8Unorm | Rg8Unorm | Rgba8Unorm | Rgba8UnormSrgb | Bgra8Unorm | Bgra8UnormSrgb => Channel::Unorm8,
        R8Snorm | Rg8Snorm | Rgba8Snorm => Channel::Snorm8,
        R8Uint | Rg8Uint | Rgba8Uint => Channel::Uint8,
        R8Sint | Rg8Sint | Rgba8Sint => Channel::Sint8,
        R16Uint | Rg16Uint | Rgba16Uint => Channel::Uint16,
        R16Sint | Rg16Sint | Rgba16Sint => Channel::Sint16,
        R16Float | Rg16Float | Rgba16Float => Channel::Float16,
        R32Uint | Rg32Uint | Rgba32Uint => Channel::Uint32,
        R32Sint | Rg32Sint | Rgba32Sint => Channel::Sint32,
        R32Float | Rg32Float | Rgba32Float => Channel::Float32,
        _ => return None,
    })
}

/// Converts one texel to floats; zeros for compressed formats, whose blocks are not texels.
fn rgba_of(format: Format, aspect: Aspect, texel: &[u8]) -> [f32; 4] {
    if let Some(channel) = channel(format) {
        let mut rgba = [0.0, 0.0, 0.0, 1.0];
        for (value, bytes) in rgba.iter_mut().zip(texel.chunks_exact(channel.bytes())) {
            *value = channel.value(bytes);
        }
        if matches!(format, Format::Bgra8Unorm | Format::Bgra8UnormSrgb) {
            rgba.swap(0, 2);
        }
        if format.is_srgb() {
            rgba[..3].iter_mut().for_each(|c| *c = linear_from_srgb(*c));
        }
        return rgba;
    }
    let packed = match texel {
        [a, b, c, d] => u32::from_le_bytes([*a, *b, *c, *d]),
        _ => 0,
    };
    let bits = |first: u32, count: u32| (packed >> first) & ((1 << count) - 1);
    match format {
        Format::Rgb10a2Unorm => {
            let color = |first| bits(first, 10) as f32 / 1023.0;
            [color(0), color(10), color(20), bits(30, 2) as f32 / 3.0]
        }
        Format::Rgb10a2Uint => [bits(0, 10) as f32, bits(10, 10) as f32, bits(20, 10) as f32, bits(30, 2) as f32],
        Format::Rg11b10Ufloat => {
            [small_float(bits(0, 11), 6), small_float(bits(11, 11), 6), small_float(bits(22, 10), 5), 1.0]
        }
        Format::Rgb9e5Ufloat => {
            let scale = f32::exp2(bits(27, 5) as f32 - 24.0);
            [bits(0, 9) as f32 * scale, bits(9, 9) as f32 * scale, bits(18, 9) as f32 * scale, 1.0]
        }
        _ => [depth_or_stencil(format, aspect, texel), 0.0, 0.0, 1.0],
    }
}

/// Converts an unsigned float with 5 exponent bits and `mantissa` mantissa bits, which is a truncated half float.
fn small_float(bits: u32, mantissa: u32) -> f32 {
    f16::from_bits((bits << (10 - mantissa)) as u16).to_f32()
}

fn depth_or_stencil(format: Format, aspect: Aspect, texel: &[u8]) -> f32 {
    let stencil = aspect == Aspect::Stencil || format == Format::Stencil8;
    match texel {
        [a] if stencil => f32::from(*a),
        [a, b] if format == Format::Depth16Unorm => f32::from(u16::from_le_bytes([*a, *b])) / 65535.0,
        [a, b, c, d] => f32::from_le_bytes([*a, *b, *c, *d]),
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pixels(format: Format, bytes: &[u8]) -> Pixels {
        Pixels { format, aspect: Aspect::All, texels: [1, 1], bytes: bytes.to_vec() }
    }

    #[test]
    fn texels_of_every_layout_are_read() {
        let cases: &[(Format, &[u8], [f32; 4])] = &[
            (Format::R8Unorm, &[255], [1.0, 0.0, 0.0, 1.0]),
            (Format::Rg8Snorm, &[127, 128], [1.0, -1.0, 0.0, 1.0]),
            (Format::Bgra8Unorm, &[0, 51, 255, 255], [1.0, 0.2, 0.0, 1.0]),
            (Format::Rgba8UnormSrgb, &[255, 0, 255, 51], [1.0, 0.0, 1.0, 0.2]),
            (Format::R16Sint, &[0xfe, 0xff], [-2.0, 0.0, 0.0, 1.0]),
            (Format::Rg16Float, &[0, 0x3c, 0, 0xc0], [1.0, -2.0, 0.0, 1.0]),
            (Format::R32Uint, &[7, 0, 0, 0], [7.0, 0.0, 0.0, 1.0]),
            (Format::Rgb10a2Unorm, &[0xff, 0x03, 0xf0, 0xff], [1.0, 0.0, 1.0, 1.0]),
            // Red 1.0: exponent 15, mantissa 0 in 11 bits; blue 2.0: exponent 16 in 10 bits.
            (Format::Rg11b10Ufloat, &(0x3c0u32 | (0x200 << 22)).to_le_bytes(), [1.0, 0.0, 2.0, 1.0]),
            // Mantissas 256, 128, 0 with exponent 16: 256 · 2⁻⁸ = 1.
            (Format::Rgb9e5Ufloat, &(256u32 | (128 << 9) | (16 << 27)).to_le_bytes(), [1.0, 0.5, 0.0, 1.0]),
            (Format::Depth16Unorm, &[0xff, 0xff], [1.0, 0.0, 0.0, 1.0]),
            (Format::Depth32Float, &0.25f32.to_le_bytes(), [0.25, 0.0, 0.0, 1.0]),
            (Format::Stencil8, &[9], [9.0, 0.0, 0.0, 1.0]),
        ];
        for (format, bytes, expected) in cases {
            assert_eq!(pixels(*format, bytes).rgba(), [*expected], "{format:?}");
        }
        assert_eq!(pixels(Format::Depth32Float, &0.25f32.to_le_bytes()).depth(), Some(vec![0.25]));
        assert_eq!(pixels(Format::R32Float, &0.25f32.to_le_bytes()).depth(), None);
    }

    #[test]
    fn normalized_bytes_are_kept_and_floats_encoded() {
        assert_eq!(pixels(Format::Bgra8UnormSrgb, &[1, 2, 3, 4]).rgba8(), [3, 2, 1, 4]);
        let floats: Vec<u8> = [0.5f32, -1.0, f32::NAN, 0.5].iter().flat_map(|f| f.to_le_bytes()).collect();
        // Linear 0.5 is 188 in 8-bit sRGB (0.735 · 255).
        assert_eq!(pixels(Format::Rgba32Float, &floats).rgba8(), [188, 0, 0, 128]);
        for code in 0..=255u8 {
            let light = linear_from_srgb(f32::from(code) / 255.0);
            assert_eq!((srgb_from_linear(light) * 255.0).round() as u8, code, "encoding and decoding are inverse");
        }
    }

    #[test]
    fn a_texel_is_found_by_column_and_row() {
        let image = Pixels { format: Format::R8Unorm, aspect: Aspect::All, texels: [2, 2], bytes: vec![1, 2, 3, 4] };
        assert_eq!((image.at(0, 1), image.at(2, 0)), (Some([3].as_slice()), None));
    }
}
