//! The GLB container (glTF 2.0, section 4).

use std::path::Path;

use crate::error::SceneError;

const HEADER_BYTES: usize = 12;
const CHUNK_HEADER_BYTES: usize = 8;

/// Splits a file into its JSON and, for GLB, its binary chunk. A file that does not begin with the
/// GLB magic is taken for JSON.
pub(super) fn split<'a>(file: &Path, bytes: &'a [u8]) -> Result<(&'a [u8], Option<&'a [u8]>), SceneError> {
    let malformed = |reason: String| SceneError::malformed(file, "GLB container", reason);
    if bytes.is_empty() {
        return Err(SceneError::malformed(file, "glTF", "the file is empty"));
    }
    if !bytes.starts_with(b"glTF") {
        let json = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        return Ok((json, None));
    }
    let (Some(version), Some(length)) = (u32_at(bytes, 4), u32_at(bytes, 8)) else {
        return Err(malformed(format!("truncated header of {} bytes", bytes.len())));
    };
    if version != 2 {
        return Err(malformed(format!("version {version}, only 2 is supported")));
    }
    let length = length as usize;
    if length < HEADER_BYTES || length > bytes.len() {
        return Err(malformed(format!("truncated: its header promises {length} bytes, the file has {}", bytes.len())));
    }
    let mut rest = &bytes[HEADER_BYTES..length];
    let (mut json, mut blob) = (None, None);
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
        // Chunks are padded to four bytes, which some writers leave out of the last one.
        rest = &body[size.next_multiple_of(4).min(body.len())..];
    }
    match json {
        Some(json) => Ok((json, blob)),
        None => Err(malformed("it has no JSON chunk".into())),
    }
}

fn u32_at(bytes: &[u8], at: usize) -> Option<u32> {
    let word = bytes.get(at..at + 4)?;
    Some(u32::from_le_bytes([word[0], word[1], word[2], word[3]]))
}
