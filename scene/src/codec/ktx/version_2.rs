//! Version 2: a header, an index of levels, metadata, and the levels at the offsets of the index. Always little-endian.

use std::ops::Range;

use super::cube::{CubeHeader, Shape, level_texels};
use super::entries::harmonics;
use super::error::KtxError;
use super::reader::Reader;
use super::texel::TexelFormat;
use crate::codec::error::CodecError;

/// Bytes of the identifier, which the caller has checked.
const MARK_BYTES: usize = 12;

/// The header of a file (KTX 2.0, section 3).
pub(super) struct Fields<'a> {
    /// Vulkan format number, 0 if there is none.
    pub vulkan_format: u32,
    pub shape: Shape,
    /// Number of the supercompression scheme, 0 for none.
    pub scheme: u32,
    /// Offset and length of the data format descriptor.
    #[cfg_attr(not(feature = "basisu"), allow(dead_code, reason = "textures alone need it"))]
    pub descriptor: [u32; 2],
    /// Offset and length of the metadata.
    pub metadata: [u32; 2],
    reader: Reader<'a>,
}

/// An entry of the index of levels.
pub(super) struct IndexEntry {
    /// Offset in the file.
    pub at: u64,
    /// Bytes in the file.
    pub length: u64,
    /// Bytes after decompression.
    #[cfg_attr(not(feature = "basisu"), allow(dead_code, reason = "textures alone may be supercompressed"))]
    pub whole: u64,
}

impl<'a> Fields<'a> {
    /// Reads the header from the first bytes of a file.
    pub fn read(bytes: &'a [u8]) -> Result<Self, KtxError> {
        let mut reader = Reader { bytes, at: MARK_BYTES, big_endian: false, what: "header" };
        let [vulkan_format, _type_size] = reader.u32s()?;
        let [width, height, depth, layers, faces, levels, scheme] = reader.u32s()?;
        let shape = Shape { size_texels: [width, height], depth, layers, faces, levels };
        let [descriptor_at, descriptor_bytes, metadata_at, metadata_bytes] = reader.u32s()?;
        let _global_data = [reader.u64()?, reader.u64()?];
        reader.what = "index of levels";
        let descriptor = [descriptor_at, descriptor_bytes];
        Ok(Self { vulkan_format, shape, scheme, descriptor, metadata: [metadata_at, metadata_bytes], reader })
    }

    /// Reads the first `levels` entries of the index; the caller has checked that there are few.
    pub fn index(mut self, levels: u32) -> Result<Vec<IndexEntry>, KtxError> {
        let entry =
            |_| Ok(IndexEntry { at: self.reader.u64()?, length: self.reader.u64()?, whole: self.reader.u64()? });
        (0..levels).map(entry).collect()
    }
}

pub(super) fn header(bytes: &[u8], max_texels: u32) -> Result<CubeHeader, CodecError> {
    let fields = Fields::read(bytes)?;
    let [size_texels, levels] = fields.shape.check(max_texels)?;
    if fields.scheme != 0 {
        return Err(KtxError::Supercompressed { scheme: fields.scheme }.into());
    }
    let unread = KtxError::Format { api: "Vulkan", number: fields.vulkan_format };
    let format = TexelFormat::of_vulkan(fields.vulkan_format).ok_or(unread)?;
    let [metadata_at, metadata_bytes] = fields.metadata;
    let mut ranges = Vec::new();
    for (level, IndexEntry { at, length, .. }) in (0..).zip(fields.index(levels)?) {
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

/// Returns a byte range of the file, or an error if it exceeds the file.
pub(super) fn within(bytes: &[u8], at: u64, length: u64, what: &'static str) -> Result<Range<usize>, KtxError> {
    let end = at.checked_add(length).filter(|end| *end <= bytes.len() as u64).ok_or(KtxError::CutShort { what })?;
    Ok(at as usize..end as usize)
}
