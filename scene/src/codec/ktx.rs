//! Khronos textures that hold a cube of light, in either version of the format: six square faces, +x −x +y −y +z −z, each
//! with its rows from the top as seen by who looks a cube up by direction.
//!
//! Floating-point texels alone are read. Filament's `cmgen` writes two such files of an environment: `_skybox.ktx`, its
//! radiance, and `_ibl.ktx`, radiance filtered for a roughness a level, with irradiance under the key `sh`.

mod entries;
mod error;
mod texel;
mod version_1;
mod version_2;

pub use error::KtxError;

use super::error::CodecError;
use super::kind::FileKind;
use entries::harmonics;
use texel::TexelFormat;

/// Nine factors of irradiance / π, a linear Rec.709 color each.
pub(crate) type Harmonics = [[f32; 3]; 9];

/// A cube of light.
pub(crate) struct CubeF32 {
    /// Width and height of the faces of the first level.
    pub size_texels: u32,
    /// The faces of each level one after the other, finest level first; four numbers a texel, linear light.
    pub levels: Vec<Vec<[f32; 4]>>,
}

/// What a file says before its texels, checked against the length of the file.
#[derive(Debug)]
pub(crate) struct CubeHeader {
    /// Width and height of the faces of the first level.
    pub size_texels: u32,
    /// Irradiance that comes with the cube, whose levels then are filtered for a roughness each.
    pub harmonics: Option<Harmonics>,
    format: TexelFormat,
    big_endian: bool,
    /// Where the bytes of each level lie in the file, finest first.
    levels: Vec<std::ops::Range<usize>>,
}

impl CubeHeader {
    /// How many levels there are.
    pub fn level_count(&self) -> u32 {
        self.levels.len() as u32
    }

    /// Bytes that the first `levels` take once they are decoded.
    pub fn decoded_bytes(&self, levels: u32) -> u64 {
        (0..levels).map(|level| 6 * 16 * u64::from(level_texels(self.size_texels, level)).pow(2)).sum()
    }

    /// Decodes the first `levels` of the file that this is the header of.
    pub fn decode(&self, bytes: &[u8], levels: u32) -> CubeF32 {
        let texel_bytes = self.format.bytes();
        let texels = |(level, range): (u32, &std::ops::Range<usize>)| {
            let face_bytes = (level_texels(self.size_texels, level) as usize).pow(2) * texel_bytes;
            // Between faces there may be padding.
            let faces = bytes[range.clone()].chunks_exact(range.len() / 6);
            let texels = faces.flat_map(|face| face[..face_bytes].chunks_exact(texel_bytes));
            texels.map(|texel| self.format.decode(texel, self.big_endian)).collect()
        };
        let levels = (0..levels).zip(&self.levels).map(texels).collect();
        CubeF32 { size_texels: self.size_texels, levels }
    }
}

/// Reads the header of a cube and checks that the file holds all of its levels.
pub(crate) fn header(kind: FileKind, bytes: &[u8], max_texels: u32) -> Result<CubeHeader, CodecError> {
    match kind {
        FileKind::Ktx1 => version_1::header(bytes, max_texels),
        _ => version_2::header(bytes, max_texels),
    }
}

/// Width and height of a level.
fn level_texels(size_texels: u32, level: u32) -> u32 {
    (size_texels >> level).max(1)
}

/// What both versions say of the shape of a texture, in the terms of their headers.
struct Shape {
    size_texels: [u32; 2],
    depth: u32,
    layers: u32,
    faces: u32,
    levels: u32,
}

impl Shape {
    /// The width of a cube and its number of levels.
    fn check(&self, max_texels: u32) -> Result<[u32; 2], CodecError> {
        let [width, height] = self.size_texels;
        if self.faces != 6 || self.depth > 1 || self.layers > 1 {
            return Err(KtxError::NoCube { faces: self.faces, depth: self.depth, layers: self.layers }.into());
        }
        super::picture::check_size(self.size_texels, [max_texels; 2])?;
        if width != height {
            return Err(KtxError::NotSquare { size_texels: self.size_texels }.into());
        }
        // None asks the reader to make the others.
        let levels = self.levels.max(1);
        if levels > width.ilog2() + 1 {
            return Err(KtxError::Levels { levels, size_texels: width }.into());
        }
        Ok([width, levels])
    }
}

/// Takes numbers from the front of a file.
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    big_endian: bool,
    /// What is being read, for errors.
    what: &'static str,
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], KtxError> {
        let end = self.at.checked_add(count).ok_or(KtxError::CutShort { what: self.what })?;
        let taken = self.bytes.get(self.at..end).ok_or(KtxError::CutShort { what: self.what })?;
        self.at = end;
        Ok(taken)
    }

    fn u32(&mut self) -> Result<u32, KtxError> {
        let four = self.take(4)?.try_into().map_err(|_| KtxError::CutShort { what: self.what })?;
        Ok(if self.big_endian { u32::from_be_bytes(four) } else { u32::from_le_bytes(four) })
    }

    fn u32s<const N: usize>(&mut self) -> Result<[u32; N], KtxError> {
        let mut numbers = [0; N];
        for number in &mut numbers {
            *number = self.u32()?;
        }
        Ok(numbers)
    }

    /// 64 bits, lower half first: version 2 alone has them, and is little-endian.
    fn u64(&mut self) -> Result<u64, KtxError> {
        let [low, high] = self.u32s()?;
        Ok(u64::from(low) | u64::from(high) << 32)
    }
}
