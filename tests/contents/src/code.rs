//! Integer texel values (codes) that every tested format stores exactly, and the hashes that passes compute from them.
//!
//! Codes make the device's rounding irrelevant:
//!
//! - Normalized formats hold 8-bit codes.
//! - sRGB formats hold 0 or 1, which the transfer function does not change.
//! - Half floats hold integers below 2¹¹, floats below 2²⁴.
//! - Depth holds multiples of 2⁻¹⁶.
//! - Stencil holds one of four values, which set and clear every bit.

use framegraph::{Aspect, ClearValue, Format};
use half::f16;

/// Codes of one texel by channel; depth and stencil use the first.
pub type Texel = [u32; 4];

/// Depth codes are multiples of 1 divided by this.
const DEPTH_STEPS: f32 = 65536.0;
/// Stencil values are multiples (0 to 3) of this.
pub const STENCIL_STEP: u32 = 85;

/// Encoding of codes in one plane of a format.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coding {
    /// Type of the plane in shaders.
    pub numeric: Numeric,
    /// Bit mask of codes by channel; 0 for missing channels.
    pub mask: Texel,
    /// Scale from channel values to codes.
    pub scale: [f32; 4],
}

/// Type of a plane in shaders.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Numeric {
    Float,
    Uint,
    Depth,
    Stencil,
}

/// Returns the planes of a format that are accessed separately.
pub fn planes(format: Format) -> Vec<Aspect> {
    match (format.has_depth(), format.has_stencil()) {
        (true, true) => vec![Aspect::Depth, Aspect::Stencil],
        (true, false) => vec![Aspect::Depth],
        (false, true) => vec![Aspect::Stencil],
        (false, false) => vec![Aspect::All],
    }
}

/// Returns the encoding of one plane.
///
/// # Panics
/// Panics for formats that the generator does not use.
pub fn coding(format: Format, plane: Aspect) -> Coding {
    let of = |numeric, mask, scale| Coding { numeric, mask, scale };
    match (format, plane) {
        (_, Aspect::Depth) => of(Numeric::Depth, [0xFFFF, 0, 0, 0], [DEPTH_STEPS, 1.0, 1.0, 1.0]),
        (_, Aspect::Stencil) => of(Numeric::Stencil, [0xFF, 0, 0, 0], [1.0; 4]),
        (Format::Rgba8Unorm, _) => of(Numeric::Float, [0xFF; 4], [255.0; 4]),
        (Format::Rgba8UnormSrgb, _) => of(Numeric::Float, [1, 1, 1, 0xFF], [1.0, 1.0, 1.0, 255.0]),
        (Format::R8Unorm, _) => of(Numeric::Float, [0xFF, 0, 0, 0], [255.0, 1.0, 1.0, 1.0]),
        (Format::Rgba16Float, _) => of(Numeric::Float, [0x7FF; 4], [1.0; 4]),
        (Format::Rgba32Float, _) => of(Numeric::Float, [0xFF_FFFF; 4], [1.0; 4]),
        (Format::R32Uint, _) => of(Numeric::Uint, [u32::MAX, 0, 0, 0], [1.0; 4]),
        _ => panic!("{format:?} has no exact codes; give it some in `coding`"),
    }
}

impl Coding {
    /// Returns the codes that a pass writes, from the hash of the texel.
    pub fn painted(&self, hash: u32) -> Texel {
        let [r, g, b, a] = self.mask;
        match self.numeric {
            Numeric::Stencil => [(hash & 3) * STENCIL_STEP, 0, 0, 0],
            _ => [mix(hash, 0) & r, mix(hash, 1) & g, mix(hash, 2) & b, mix(hash, 3) & a],
        }
    }

    /// Returns the codes of a clear value for this plane.
    pub fn cleared(&self, value: ClearValue) -> Texel {
        match (self.numeric, value) {
            (Numeric::Depth, ClearValue::DepthStencil(depth, _)) => [(depth * DEPTH_STEPS).round() as u32, 0, 0, 0],
            (Numeric::Stencil, ClearValue::DepthStencil(_, stencil)) => [stencil & 0xFF, 0, 0, 0],
            (Numeric::Float | Numeric::Uint, ClearValue::Color(color)) => {
                let code = |channel: usize| (color[channel] as f32 * self.scale[channel]).round() as u32;
                [0, 1, 2, 3].map(|channel| code(channel) & self.mask[channel])
            }
            _ => [0; 4],
        }
    }
}

/// Returns the bytes of one texel of a plane that can be copied to buffers.
pub fn bytes_of(format: Format, plane: Aspect, codes: Texel) -> Vec<u8> {
    match plane {
        Aspect::Stencil => return vec![codes[0] as u8],
        Aspect::Depth => return (codes[0] as f32 / DEPTH_STEPS).to_le_bytes().to_vec(),
        Aspect::All => {}
    }
    let half = |code: u32| f16::from_f32(code as f32).to_le_bytes();
    match format {
        Format::Rgba8Unorm => codes.map(|c| c as u8).to_vec(),
        Format::Rgba8UnormSrgb => [codes[0] * 255, codes[1] * 255, codes[2] * 255, codes[3]].map(|c| c as u8).to_vec(),
        Format::R8Unorm => vec![codes[0] as u8],
        Format::Rgba16Float => codes.map(half).concat(),
        Format::Rgba32Float => codes.map(|c| (c as f32).to_le_bytes()).concat(),
        Format::R32Uint => codes[0].to_le_bytes().to_vec(),
        _ => panic!("{format:?} has no bytes in a buffer"),
    }
}

/// Returns a hash of two numbers, with two multiplications and two shifts. Shaders contain the same function.
pub fn mix(hash: u32, value: u32) -> u32 {
    let mut x = (hash ^ value).wrapping_mul(0x9E37_79B1);
    x = (x ^ (x >> 15)).wrapping_mul(0x85EB_CA77);
    x ^ (x >> 13)
}

/// Computes one step of a digest. Uses its argument once: long chains of [`mix`] take Mesa's shader optimizer too long,
/// since it follows each use separately.
pub fn fold(hash: u32, value: u32) -> u32 {
    (hash ^ value).wrapping_mul(0x9E37_79B1).wrapping_add(0x7F4A_7C15)
}

/// Number of texels of a part, or words of a buffer, that a digest samples.
pub const LOOKS: u32 = 32;

/// Returns the index, out of `count`, that sample `look` of a digest reads.
pub fn look(look: u32, count: u32) -> u32 {
    (look * 61 + 7) % count
}

/// Returns the hash that a texel or word of an output is derived from.
pub fn texel_hash(digest: u32, tag: u32, x: u32, y: u32) -> u32 {
    mix(mix(digest, tag), y * 65536 + x)
}

/// Returns whether a pass that keeps older contents writes this texel: one in four.
pub fn chosen(salt: u32, tag: u32, x: u32, y: u32) -> bool {
    mix(mix(salt, tag ^ 0x5EED), y * 65536 + x) & 3 == 0
}

/// Returns a word that a pass writes to a buffer. The first four are small, so that they can be indirect arguments.
pub fn word(digest: u32, tag: u32, index: u32) -> u32 {
    let hash = texel_hash(digest, tag, index, 0);
    if index < 4 { 3 + (hash & 3) } else { hash }
}
