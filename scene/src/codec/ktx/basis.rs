//! Basis Universal texels, transcoded by the `basisu` crate.

use std::borrow::Cow;

use basisu::{DecodeFlags, TargetFormat, Transcoder};

use super::error::KtxError;
use super::version_2::{IndexEntry, within};
use crate::codec::error::CodecError;
use crate::texture::{BlockFormats, ImageFormat, level_size};

/// The two codecs of KHR_texture_basisu.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    Etc1s,
    Uastc,
}

impl Source {
    /// Returns the format with the least loss: ETC1S is a subset of ETC2, UASTC of ASTC, and BC7 is close to both.
    pub fn block_format(self, formats: BlockFormats) -> ImageFormat {
        let etc2 = (formats.etc2, ImageFormat::Etc2Rgba8);
        let bc7 = (formats.bc7, ImageFormat::Bc7);
        let astc = (formats.astc, ImageFormat::Astc4x4);
        let order = match self {
            Self::Etc1s => [etc2, bc7, astc],
            Self::Uastc => [astc, bc7, etc2],
        };
        order.into_iter().find(|(is_there, _)| *is_there).map_or(ImageFormat::Rgba8, |(_, format)| format)
    }
}

/// Returns the maximum number of bytes that transcoding ETC1S allocates in addition to its output. A block has indices
/// of 8 bytes. Code books have at most 65,535 endpoints and selectors, with their Huffman tables.
pub(super) fn etc1s_working_bytes(size_texels: [u32; 2]) -> u64 {
    let blocks = ImageFormat::Etc2Rgba8.level_bytes(size_texels) / 16;
    8 * blocks + (2 << 20)
}

/// A KTX2 file for the transcoder: without supercompression other than BasisLZ, which is part of the codec.
pub(super) struct BasisFile<'a>(Cow<'a, [u8]>);

impl<'a> BasisFile<'a> {
    /// Returns an ETC1S file unchanged if it contains all of these levels.
    pub fn of_etc1s(bytes: &'a [u8], levels: &[IndexEntry]) -> Result<Self, KtxError> {
        for entry in levels {
            within(bytes, entry.at, entry.length, "levels")?;
        }
        Ok(Self(bytes.into()))
    }

    /// Builds a UASTC file from decompressed levels and a data format descriptor.
    pub fn of_uastc([width, height]: [u32; 2], descriptor: &[u8], levels: &[Vec<u8>]) -> Self {
        let (count, level_bytes) = (levels.len(), levels.iter().map(Vec::len).sum::<usize>());
        let descriptor_at = HEADER_BYTES + count * INDEX_BYTES;
        let mut at = descriptor_at + descriptor.len();
        let mut file = Vec::with_capacity(at + level_bytes);
        file.extend(MARK);
        // No format of Vulkan, type size 1; depth and layers 0, one face; no supercompression, metadata or global data.
        let sizes = [0, 1, width, height, 0, 0, 1, count as u32, 0];
        let places = [descriptor_at as u32, descriptor.len() as u32, 0, 0, 0, 0, 0, 0];
        sizes.iter().chain(&places).for_each(|number: &u32| file.extend(number.to_le_bytes()));
        for level in levels {
            [at, level.len(), level.len()].iter().for_each(|number| file.extend((*number as u64).to_le_bytes()));
            at += level.len();
        }
        file.extend(descriptor);
        levels.iter().for_each(|level| file.extend(level));
        Self(file.into())
    }

    /// Transcodes the first `count` levels.
    pub fn transcode(&self, format: ImageFormat, count: u32) -> Result<Vec<Vec<u8>>, CodecError> {
        let target = match format {
            ImageFormat::Rgba8 => TargetFormat::Rgba32,
            ImageFormat::Bc7 => TargetFormat::Bc7Rgba,
            ImageFormat::Etc2Rgba8 => TargetFormat::Etc2Rgba,
            ImageFormat::Astc4x4 => TargetFormat::Astc4x4Rgba,
        };
        let file = Transcoder::new(&self.0).map_err(|_| KtxError::Transcode { level: 0 })?;
        let (width, height) = file.base_dimensions();
        let level = |level| {
            let broken = KtxError::Transcode { level };
            let texels = file.transcode(level, target, DecodeFlags::NONE).map_err(|_| broken)?;
            let expected = format.level_bytes(level_size([width, height], level));
            if texels.len() as u64 == expected { Ok(texels) } else { Err(broken.into()) }
        };
        (0..count).map(level).collect()
    }
}

/// Identifier of version 2 (KTX 2.0, section 3.1).
const MARK: [u8; 12] = [0xab, b'K', b'T', b'X', b' ', b'2', b'0', 0xbb, b'\r', b'\n', 0x1a, b'\n'];
/// Bytes of the identifier and the header, before the level index.
const HEADER_BYTES: usize = 80;
/// Bytes of an entry of the level index.
const INDEX_BYTES: usize = 24;
