//! The GLB container (glTF 2.0, section 4).

use std::path::Path;

use crate::error::{SceneError, Unsupported};

const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;

/// Parts of a file.
pub(super) struct Parts<'a> {
    /// JSON chunk.
    pub json: &'a [u8],
    /// Binary chunk of a GLB file.
    pub blob: Option<&'a [u8]>,
    /// True if a chunk follows another one without the padding to four bytes that section 4.4.1 demands.
    pub is_unpadded: bool,
}

/// Splits a file into its JSON and, for GLB, its binary chunk. A file without the GLB magic is taken for JSON.
pub(super) fn split<'a>(file: &Path, bytes: &'a [u8]) -> Result<Parts<'a>, SceneError> {
    let malformed = |reason: String| SceneError::malformed(file, "GLB container", reason);
    if bytes.is_empty() {
        return Err(SceneError::malformed(file, "glTF", "the file is empty"));
    }
    if !bytes.starts_with(b"glTF") {
        let json = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        return Ok(Parts { json, blob: None, is_unpadded: false });
    }
    let (Some(version), Some(length)) = (u32_at(bytes, 4), u32_at(bytes, 8)) else {
        return Err(malformed(format!("truncated header of {} bytes", bytes.len())));
    };
    if version == 1 {
        let feature = Unsupported::GltfVersion("1.0".into());
        return Err(SceneError::Unsupported { file: file.into(), feature });
    }
    if version != 2 {
        return Err(malformed(format!("version {version}, only 2 is supported")));
    }
    let length = length as usize;
    if length < HEADER_BYTES || length > bytes.len() {
        return Err(malformed(format!("truncated: its header promises {length} bytes, the file has {}", bytes.len())));
    }
    let mut rest = &bytes[HEADER_BYTES..length];
    let (mut json, mut blob, mut is_unpadded) = (None, None, false);
    while !rest.is_empty() {
        let (Some(size), Some(kind)) = (u32_at(rest, 0), rest.get(4..CHUNK_HEADER_BYTES)) else {
            return Err(malformed("truncated chunk header".into()));
        };
        let body = &rest[CHUNK_HEADER_BYTES..];
        let size = size as usize;
        if size > body.len() {
            return Err(malformed(format!("truncated: a chunk promises {size} bytes, {} are left", body.len())));
        }
        match (kind, json.is_some()) {
            (b"JSON", false) => json = Some(&body[..size]),
            (_, false) => return Err(malformed("the first chunk is not JSON".into())),
            (b"BIN\0", true) if blob.is_none() => blob = Some(&body[..size]),
            // Unknown chunks must be ignored (section 4.4.1).
            _ => {}
        }
        // Chunks are padded to four bytes, but some writers omit the padding.
        let padded = size.next_multiple_of(4).min(body.len());
        let is_next = |at: usize| starts_chunk(&body[at..]);
        let next = if !is_next(padded) && is_next(size) { size } else { padded };
        is_unpadded |= next != padded;
        rest = &body[next..];
    }
    match json {
        // Some writers pad with zeros instead of spaces.
        Some(json) => Ok(Parts { json: without_zeros(json), blob, is_unpadded }),
        None => Err(malformed("it has no JSON chunk".into())),
    }
}

/// Returns true if the bytes begin with the header of a binary chunk that ends within them.
fn starts_chunk(bytes: &[u8]) -> bool {
    let fits = u32_at(bytes, 0).is_some_and(|size| size as usize <= bytes.len() - CHUNK_HEADER_BYTES.min(bytes.len()));
    fits && bytes.get(4..CHUNK_HEADER_BYTES) == Some(b"BIN\0".as_slice())
}

/// Returns `json` without the zeros at its end.
fn without_zeros(json: &[u8]) -> &[u8] {
    let zeros = json.iter().rev().take_while(|byte| **byte == 0).count();
    &json[..json.len() - zeros]
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    let word = bytes.get(at..at + 4)?;
    Some(u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
}
