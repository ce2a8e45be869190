//! Version 2: a header, an index of levels, metadata, then the levels wherever the index says. Always little-endian.

use super::cube::{CubeHeader, Shape, level_texels};
use super::entries::harmonics;
use super::error::KtxError;
use super::reader::Reader;
use super::texel::TexelFormat;
use crate::codec::error::CodecError;

/// Bytes of the file's mark, which the caller has seen.
const MARK_BYTES: usize = 12;

pub(super) fn header(bytes: &[u8], max_texels: u32) -> Result<CubeHeader, CodecError> {
    let mut reader = Reader { bytes, at: MARK_BYTES, big_endian: false, what: "header" };
    let [vulkan_format, _type_size] = reader.u32s()?;
    let [width, height, depth, layers, faces, levels, scheme] = reader.u32s()?;
    let shape = Shape { size_texels: [width, height], depth, layers, faces, levels };
    let [size_texels, levels] = shape.check(max_texels)?;
    if scheme != 0 {
        return Err(KtxError::Supercompressed { scheme }.into());
    }
    let unread = KtxError::Format { api: "Vulkan", number: vulkan_format };
    let format = TexelFormat::of_vulkan(vulkan_format).ok_or(unread)?;
    let [_descriptor_at, _descriptor_bytes, metadata_at, metadata_bytes] = reader.u32s()?;
    let _global_data = [reader.u64()?, reader.u64()?];
    reader.what = "index of levels";
    let mut ranges = Vec::new();
    for level in 0..levels {
        let [at, length, _uncompressed] = [reader.u64()?, reader.u64()?, reader.u64()?];
        let expected = 6 * u64::from(level_texels(size_texels, level)).pow(2) * format.bytes() as u64;
        if length != expected {
            return Err(KtxError::LevelBytes { level, found: length, expected }.into());
        }
        ranges.push(within(bytes, at, length, "levels")?);
    }
    let metadata = within(bytes, metadata_at.into(), metadata_bytes.into(), "metadata")?;
    let harmonics = harmonics(&bytes[metadata], false)?;
    Ok(CubeHeader { size_texels, harmonics, format, big_endian: false, levels: ranges })
}

/// A part of the file, if the file has it.
fn within(bytes: &[u8], at: u64, length: u64, what: &'static str) -> Result<std::ops::Range<usize>, KtxError> {
    let end = at.checked_add(length).filter(|end| *end <= bytes.len() as u64).ok_or(KtxError::CutShort { what })?;
    Ok(at as usize..end as usize)
}
