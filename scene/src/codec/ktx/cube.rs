//! Cube map of radiance as stored in a file.

use super::error::KtxError;
use super::texel::TexelFormat;
use crate::codec::error::CodecError;
use crate::codec::picture::check_size;

/// Nine coefficients of irradiance / π, a linear Rec.709 color each.
pub(crate) type Harmonics = [[f32; 3]; 9];

/// Cube map of radiance.
pub(crate) struct CubeF32 {
    /// Width and height of the faces of the first level.
    pub size_texels: u32,
    /// Faces of each level in order, finest level first; four numbers a texel, linear light.
    pub levels: Vec<Vec<[f32; 4]>>,
}

/// Header of a cube map, checked against the length of the file.
#[derive(Debug)]
pub(crate) struct CubeHeader {
    /// Width and height of the faces of the first level.
    pub size_texels: u32,
    /// Irradiance in the file, if any; the levels are then prefiltered by roughness.
    pub harmonics: Option<Harmonics>,
    pub(super) format: TexelFormat,
    pub(super) big_endian: bool,
    /// Byte range of each level in the file, finest first.
    pub(super) levels: Vec<std::ops::Range<usize>>,
}

impl CubeHeader {
    /// Returns the number of levels.
    pub fn level_count(&self) -> u32 {
        self.levels.len() as u32
    }

    /// Returns the bytes of the first `levels` after decoding.
    pub fn decoded_bytes(&self, levels: u32) -> u64 {
        (0..levels).map(|level| 6 * 16 * u64::from(level_texels(self.size_texels, level)).pow(2)).sum()
    }

    /// Decodes the first `levels` of the file with this header.
    pub fn decode(&self, bytes: &[u8], levels: u32) -> CubeF32 {
        let texel_bytes = self.format.bytes();
        let texels = |(level, range): (u32, &std::ops::Range<usize>)| {
            let face_bytes = (level_texels(self.size_texels, level) as usize).pow(2) * texel_bytes;
            // Faces may be padded.
            let faces = bytes[range.clone()].chunks_exact(range.len() / 6);
            let texels = faces.flat_map(|face| face[..face_bytes].chunks_exact(texel_bytes));
            texels.map(|texel| self.format.decode(texel, self.big_endian)).collect()
        };
        let levels = (0..levels).zip(&self.levels).map(texels).collect();
        CubeF32 { size_texels: self.size_texels, levels }
    }
}

/// Returns the width and height of a level.
pub(super) fn level_texels(size_texels: u32, level: u32) -> u32 {
    (size_texels >> level).max(1)
}

/// Shape of a texture, in the terms of both headers.
pub(super) struct Shape {
    pub size_texels: [u32; 2],
    pub depth: u32,
    pub layers: u32,
    pub faces: u32,
    pub levels: u32,
}

impl Shape {
    /// Returns the width of a cube map and its number of levels.
    pub fn check(&self, max_texels: u32) -> Result<[u32; 2], CodecError> {
        let [width, height] = self.size_texels;
        if self.faces != 6 || self.depth > 1 || self.layers > 1 {
            return Err(KtxError::NoCube { faces: self.faces, depth: self.depth, layers: self.layers }.into());
        }
        check_size(self.size_texels, [max_texels; 2])?;
        if width != height {
            return Err(KtxError::NotSquare { size_texels: self.size_texels }.into());
        }
        // Zero levels ask the reader to generate the mip chain.
        let levels = self.levels.max(1);
        if levels > width.ilog2() + 1 {
            return Err(KtxError::Levels { levels, size_texels: width }.into());
        }
        Ok([width, levels])
    }
}
