//! Textures of materials in version 2 (KHR_texture_basisu): one 2D image in Basis Universal or with eight bits a
//! channel.

use super::basis::{BasisFile, Source};
use super::error::KtxError;
use super::inflate::{Scheme, inflate};
use super::version_2::{Fields, IndexEntry, within};
use crate::codec::error::CodecError;
use crate::codec::picture::{TextureHeader, TextureLevels, check_size, opaque};
use crate::mips::level_count;
use crate::texture::{BlockFormats, ImageFormat, level_size};

/// Number of BasisLZ, the supercompression of ETC1S.
const BASIS_LZ: u32 = 1;
/// Color models of the data format descriptor (Khronos Data Format 1.4, section 5.6).
const MODEL_ETC1S: u8 = 163;
const MODEL_UASTC: u8 = 166;
/// Offset of the color model in the data format descriptor, behind the total size and the first two words of the block.
const MODEL_AT: u64 = 12;

/// Layout of texels in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Texels {
    /// Three bytes a texel.
    Rgb8,
    /// Four bytes a texel.
    Rgba8,
    /// Basis Universal.
    Basis(Source),
}

impl Texels {
    fn of(vulkan_format: u32, model: u8) -> Option<Self> {
        match (vulkan_format, model) {
            // VK_FORMAT_R8G8B8_UNORM and _SRGB, VK_FORMAT_R8G8B8A8_UNORM and _SRGB.
            (23 | 29, _) => Some(Self::Rgb8),
            (37 | 43, _) => Some(Self::Rgba8),
            (0, MODEL_ETC1S) => Some(Self::Basis(Source::Etc1s)),
            (0, MODEL_UASTC) => Some(Self::Basis(Source::Uastc)),
            _ => None,
        }
    }

    /// Returns the decompressed bytes of a level in the file; `None` if they depend on its content.
    fn level_bytes(self, [width, height]: [u32; 2]) -> Option<u64> {
        let texels = u64::from(width) * u64::from(height);
        match self {
            Self::Rgb8 => Some(3 * texels),
            Self::Rgba8 => Some(4 * texels),
            Self::Basis(Source::Uastc) => Some(ImageFormat::Astc4x4.level_bytes([width, height])),
            Self::Basis(Source::Etc1s) => None,
        }
    }
}

/// Checked header of a file.
pub(in crate::codec) struct Header {
    size_texels: [u32; 2],
    texels: Texels,
    scheme: Scheme,
    /// Format of decoded texels.
    format: ImageFormat,
    /// Levels to decode, finest first: all, or only the first if some are missing.
    levels: Vec<IndexEntry>,
    /// Offset and length of the data format descriptor.
    descriptor: [u32; 2],
}

/// Reads the header of a texture. The bytes may be the first of a longer file.
pub(in crate::codec) fn header(
    bytes: &[u8],
    max_side_texels: u32,
    formats: BlockFormats,
) -> Result<Header, CodecError> {
    let fields = Fields::read(bytes)?;
    let (shape, descriptor) = (&fields.shape, fields.descriptor);
    let size_texels = shape.size_texels;
    check_size(size_texels, [max_side_texels; 2])?;
    if shape.faces != 1 || shape.depth > 1 || shape.layers > 1 {
        return Err(KtxError::NotFlat { faces: shape.faces, depth: shape.depth, layers: shape.layers }.into());
    }
    let model_at = within(bytes, u64::from(descriptor[0]) + MODEL_AT, 1, "data format descriptor")?;
    let model = bytes[model_at.start];
    let unread = KtxError::Texels { format: fields.vulkan_format, model };
    let texels = Texels::of(fields.vulkan_format, model).ok_or(unread)?;
    let of_number = match texels {
        Texels::Basis(Source::Etc1s) => Some(Scheme::Plain).filter(|_| fields.scheme == BASIS_LZ),
        _ => Scheme::of(fields.scheme),
    };
    let scheme = of_number.ok_or(KtxError::Scheme { scheme: fields.scheme })?;
    // Zero levels ask the reader to generate the mip chain.
    let (count, full) = (shape.levels.max(1), level_count(size_texels[0], size_texels[1]));
    if count > full {
        let side = size_texels[0].max(size_texels[1]);
        return Err(KtxError::Levels { levels: count, size_texels: side }.into());
    }
    let mut levels = fields.index(count)?;
    let is_complete = count == full;
    levels.truncate(if is_complete { levels.len() } else { 1 });
    for (level, entry) in (0..).zip(&levels) {
        let found = if scheme == Scheme::Plain { entry.length } else { entry.whole };
        match texels.level_bytes(level_size(size_texels, level)) {
            Some(expected) if expected != found => {
                return Err(KtxError::LevelBytes { level, found, expected }.into());
            }
            _ => {}
        }
    }
    // Block formats require a first level of whole blocks.
    let has_whole_blocks = size_texels.iter().all(|side| side.is_multiple_of(4));
    let format = match texels {
        Texels::Basis(source) if is_complete && has_whole_blocks => source.block_format(formats),
        _ => ImageFormat::Rgba8,
    };
    Ok(Header { size_texels, texels, scheme, format, levels, descriptor })
}

impl Header {
    /// Returns the size and memory needs of the texture.
    pub fn summary(&self) -> TextureHeader {
        let sizes = || (0..self.levels.len() as u32).map(|level| level_size(self.size_texels, level));
        let image_bytes = sizes().map(|size| self.format.level_bytes(size)).sum();
        let working_bytes = match self.texels {
            Texels::Basis(Source::Etc1s) => super::basis::etc1s_working_bytes(self.size_texels),
            texels => {
                let inflated: u64 = sizes().filter_map(|size| texels.level_bytes(size)).sum();
                let largest = texels.level_bytes(self.size_texels).unwrap_or(0);
                // All levels together, and each a second time while it is decompressed.
                2 * inflated + self.scheme.working_bytes(largest)
            }
        };
        TextureHeader { size_texels: self.size_texels, image_bytes, working_bytes }
    }

    /// Returns the decompressed bytes of a level. Not for ETC1S, which the transcoder decompresses.
    fn inflated(&self, bytes: &[u8], level: u32) -> Result<Vec<u8>, CodecError> {
        let entry = &self.levels[level as usize];
        let expected = self.texels.level_bytes(level_size(self.size_texels, level)).unwrap_or(0);
        let stored = &bytes[within(bytes, entry.at, entry.length, "levels")?];
        inflate(self.scheme, stored, expected as usize).ok_or_else(|| KtxError::Inflate { level, expected }.into())
    }
}

/// Decodes the levels of a texture: to one of the block `formats` if possible, otherwise to RGBA with eight bits a
/// channel.
pub(in crate::codec) fn decode(
    bytes: &[u8],
    max_side_texels: u32,
    formats: BlockFormats,
) -> Result<TextureLevels, CodecError> {
    let header = header(bytes, max_side_texels, formats)?;
    let (size_texels, format, count) = (header.size_texels, header.format, header.levels.len() as u32);
    let levels = match header.texels {
        Texels::Rgba8 => (0..count).map(|level| header.inflated(bytes, level)).collect::<Result<_, _>>(),
        Texels::Rgb8 => (0..count).map(|level| header.inflated(bytes, level).map(|rgb| opaque(&rgb))).collect(),
        Texels::Basis(Source::Etc1s) => BasisFile::of_etc1s(bytes, &header.levels)?.transcode(format, count),
        Texels::Basis(Source::Uastc) => {
            let levels: Result<Vec<_>, CodecError> = (0..count).map(|level| header.inflated(bytes, level)).collect();
            let [at, length] = header.descriptor.map(u64::from);
            let descriptor = &bytes[within(bytes, at, length, "data format descriptor")?];
            BasisFile::of_uastc(size_texels, descriptor, &levels?).transcode(format, count)
        }
    };
    Ok(TextureLevels { size_texels, format, levels: levels? })
}
