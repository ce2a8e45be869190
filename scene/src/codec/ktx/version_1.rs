//! Version 1: a header of 16 words, metadata, then each level preceded by its length.

use super::cube::{CubeHeader, Shape, level_texels};
use super::entries::harmonics;
use super::error::KtxError;
use super::reader::Reader;
use super::texel::TexelFormat;
use crate::codec::error::CodecError;

/// Bytes of the identifier, which the caller has checked.
const MARK_BYTES: usize = 12;
const LITTLE_ENDIAN: u32 = 0x0403_0201;
const BIG_ENDIAN: u32 = 0x0102_0304;

pub(super) fn header(bytes: &[u8], max_texels: u32) -> Result<CubeHeader, CodecError> {
    let mut reader = Reader { bytes, at: MARK_BYTES, big_endian: false, what: "header" };
    reader.big_endian = match reader.u32()? {
        LITTLE_ENDIAN => false,
        BIG_ENDIAN => true,
        mark => return Err(KtxError::Endianness { mark }.into()),
    };
    let [_type, _type_size, _format, internal_format, _base_format] = reader.u32s()?;
    let [width, height, depth, layers, faces, levels, metadata_bytes] = reader.u32s()?;
    let shape = Shape { size_texels: [width, height], depth, layers, faces, levels };
    let [size_texels, levels] = shape.check(max_texels)?;
    let unread = KtxError::Format { api: "OpenGL", number: internal_format };
    let format = TexelFormat::of_gl(internal_format).ok_or(unread)?;
    reader.what = "metadata";
    let harmonics = harmonics(reader.take(metadata_bytes as usize)?, reader.big_endian)?;
    reader.what = "levels";
    let levels =
        (0..levels).map(|level| level_of(&mut reader, size_texels, format, level)).collect::<Result<_, _>>()?;
    Ok(CubeHeader { size_texels, harmonics, format, big_endian: reader.big_endian, levels })
}

/// Returns the bytes of the next level. Faces and levels are padded to four bytes. For a cube map that is not an array,
/// the stored length is that of one face.
fn level_of(
    reader: &mut Reader<'_>,
    size_texels: u32,
    format: TexelFormat,
    level: u32,
) -> Result<std::ops::Range<usize>, KtxError> {
    let face = (level_texels(size_texels, level) as usize).pow(2) * format.bytes();
    let found = reader.u32()?;
    if found as usize != face {
        return Err(KtxError::LevelBytes { level, found: found.into(), expected: face as u64 });
    }
    let start = reader.at;
    reader.take(6 * face.next_multiple_of(4))?;
    Ok(start..reader.at)
}
