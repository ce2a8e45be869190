//! Texels as whole numbers that every format of the generator holds exactly, and the hashes that passes make of them.
//!
//! A channel of a normalised format holds a code of 8 bits, of an sRGB format 0 or 1 (its transfer function maps both to
//! themselves), of a half a whole number below 2¹¹, of a float one below 2²⁴, of depth a multiple of 2⁻¹⁶, of stencil one
//! of four values that set and clear every bit. Rounding of the device then cannot matter.

use framegraph::{Aspect, ClearValue, Format};
use half::f16;

/// The codes of one texel: of one channel each; depth and stencil in the first.
pub type Texel = [u32; 4];

/// Depth codes are multiples of one over this.
const DEPTH_STEPS: f32 = 65536.0;
/// Stencil values are this times 0 to 3.
pub const STENCIL_STEP: u32 = 85;

/// How one plane of a format holds codes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coding {
    /// What shaders see of it.
    pub numeric: Numeric,
    /// The bits of a code, by channel; 0 for a channel that is not there.
    pub mask: Texel,
    /// A code is the channel's value times this.
    pub scale: [f32; 4],
}

/// What shaders see of a plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Numeric {
    Float,
    Uint,
    Depth,
    Stencil,
}

/// The planes of a format, by what tells them apart.
pub fn planes(format: Format) -> Vec<Aspect> {
    match (format.has_depth(), format.has_stencil()) {
        (true, true) => vec![Aspect::Depth, Aspect::Stencil],
        (true, false) => vec![Aspect::Depth],
        (false, true) => vec![Aspect::Stencil],
        (false, false) => vec![Aspect::All],
    }
}

/// How one plane holds codes.
///
/// # Panics
/// For a format that the generator does not use.
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
    /// The codes that a pass paints, from the hash of the texel.
    pub fn painted(&self, hash: u32) -> Texel {
        let [r, g, b, a] = self.mask;
        match self.numeric {
            Numeric::Stencil => [(hash & 3) * STENCIL_STEP, 0, 0, 0],
            _ => [mix(hash, 0) & r, mix(hash, 1) & g, mix(hash, 2) & b, mix(hash, 3) & a],
        }
    }

    /// The codes of a clear value, as an attachment of this plane takes it.
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

/// The bytes of one texel of a plane that can be copied into buffers.
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

/// A hash of two numbers: two odd multipliers and two shifts. The shaders have the same.
pub fn mix(hash: u32, value: u32) -> u32 {
    let mut x = (hash ^ value).wrapping_mul(0x9E37_79B1);
    x = (x ^ (x >> 15)).wrapping_mul(0x85EB_CA77);
    x ^ (x >> 13)
}

/// One step of a digest. Its argument is used once: with [`mix`] in long chains, a shader takes Mesa's optimizer, which looks
/// at each use anew, for ever to compile.
pub fn fold(hash: u32, value: u32) -> u32 {
    (hash ^ value).wrapping_mul(0x9E37_79B1).wrapping_add(0x7F4A_7C15)
}

/// How many texels of a part, or words of a buffer, a digest looks at.
pub const LOOKS: u32 = 32;

/// The index of the texel or word that look number `look` of a digest falls on, of `count`.
pub fn look(look: u32, count: u32) -> u32 {
    (look * 61 + 7) % count
}

/// The hash that a texel (or word) of an output is painted from.
pub fn texel_hash(digest: u32, tag: u32, x: u32, y: u32) -> u32 {
    mix(mix(digest, tag), y * 65536 + x)
}

/// Whether a pass that keeps older contents paints this texel: one in four.
pub fn chosen(salt: u32, tag: u32, x: u32, y: u32) -> bool {
    mix(mix(salt, tag ^ 0x5EED), y * 65536 + x) & 3 == 0
}

/// A word of a buffer that a pass writes; the first four are small, so that they can be arguments of indirect work.
pub fn word(digest: u32, tag: u32, index: u32) -> u32 {
    let hash = texel_hash(digest, tag, index, 0);
    if index < 4 { 3 + (hash & 3) } else { hash }
}
