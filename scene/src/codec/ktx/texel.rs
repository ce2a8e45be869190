//! Floating-point texels.

use half::f16;

/// Storage format of a texel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum TexelFormat {
    /// Number of half-float channels.
    Half(usize),
    /// Number of 32-bit float channels.
    Float(usize),
    /// Packed floats: red and green with 11 bits, blue with 10, red in the lowest bits; 5-bit exponents, no sign.
    Rg11b10,
    /// Shared exponent: three mantissas of 9 bits, red in the lowest bits, and an exponent of 5 bits.
    Rgb9e5,
}

impl TexelFormat {
    /// Names of the supported formats, for errors.
    pub const NAMES: &'static str = "RGBA and RGB of 16 or 32 bits, R11G11B10 and RGB9E5 (all floating-point)";

    /// Returns the format for an OpenGL internal format number.
    pub fn of_gl(number: u32) -> Option<Self> {
        Some(match number {
            0x881a => Self::Half(4),
            0x881b => Self::Half(3),
            0x8814 => Self::Float(4),
            0x8815 => Self::Float(3),
            0x8c3a => Self::Rg11b10,
            0x8c3d => Self::Rgb9e5,
            _ => return None,
        })
    }

    /// Returns the format for a Vulkan format number.
    pub fn of_vulkan(number: u32) -> Option<Self> {
        Some(match number {
            97 => Self::Half(4),
            90 => Self::Half(3),
            109 => Self::Float(4),
            106 => Self::Float(3),
            122 => Self::Rg11b10,
            123 => Self::Rgb9e5,
            _ => return None,
        })
    }

    /// Returns the bytes of a texel.
    pub fn bytes(self) -> usize {
        match self {
            Self::Half(channels) => 2 * channels,
            Self::Float(channels) => 4 * channels,
            Self::Rg11b10 | Self::Rgb9e5 => 4,
        }
    }

    /// Returns red, green and blue of a texel, with alpha 1.
    pub fn decode(self, bytes: &[u8], big_endian: bool) -> [f32; 4] {
        let half = |at: usize| f16::from_bits(word(&bytes[2 * at..2 * at + 2], big_endian) as u16).to_f32();
        let float = |at: usize| f32::from_bits(word(&bytes[4 * at..4 * at + 4], big_endian));
        let [r, g, b] = match self {
            Self::Half(_) => [0, 1, 2].map(half),
            Self::Float(_) => [0, 1, 2].map(float),
            Self::Rg11b10 => {
                let packed = word(bytes, big_endian);
                // Half float without its sign bit and the lowest mantissa bits.
                let short = |bits: u32, drop: u32| f16::from_bits((bits << drop) as u16).to_f32();
                [short(packed & 0x7ff, 4), short(packed >> 11 & 0x7ff, 4), short(packed >> 22, 5)]
            }
            Self::Rgb9e5 => {
                let packed = word(bytes, big_endian);
                let unit = (f64::from(packed >> 27) - 15.0 - 9.0).exp2() as f32;
                [0, 9, 18].map(|shift| (packed >> shift & 0x1ff) as f32 * unit)
            }
        };
        [r, g, b, 1.0]
    }
}

/// Reads two or four bytes as a number.
fn word(bytes: &[u8], big_endian: bool) -> u32 {
    let add = |sum: u32, byte: &u8| sum << 8 | u32::from(*byte);
    if big_endian { bytes.iter().fold(0, add) } else { bytes.iter().rev().fold(0, add) }
}
