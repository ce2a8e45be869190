//! Loading the buffers of a document.

use std::borrow::Cow;
use std::path::Path;

use gltf_json::Root;

use super::uri::{Resource, resolve};
use crate::error::SceneError;
use crate::progress::{Progress, ProgressFn, Stage, report};
use crate::read::read_file;

/// The bytes of every buffer; a buffer without a URI is the binary chunk `blob`.
pub(super) fn load<'a>(
    file: &Path,
    root: &Root,
    blob: Option<&'a [u8]>,
    progress: &mut ProgressFn<'_>,
) -> Result<Vec<Cow<'a, [u8]>>, SceneError> {
    let mut buffers = Vec::new();
    for (i, buffer) in root.buffers.iter().enumerate() {
        let at = format!("buffer {i}");
        let bytes: Cow<'a, [u8]> = match (&buffer.uri, blob) {
            (Some(uri), _) => match resolve(file, &at, uri)? {
                Resource::Bytes(bytes) => Cow::Owned(bytes),
                Resource::File(path) => Cow::Owned(read_file(&path)?),
            },
            (None, Some(blob)) if i == 0 => Cow::Borrowed(blob),
            (None, _) => {
                let reason = "it has neither a URI nor a binary chunk";
                return Err(SceneError::malformed(file, at, reason));
            }
        };
        let (promised, found) = (buffer.byte_length.0, bytes.len() as u64);
        if found < promised {
            let reason = format!("truncated: {promised} bytes are promised, {found} are there");
            return Err(SceneError::malformed(file, at, reason));
        }
        buffers.push(bytes);
        report(progress, file, Progress { stage: Stage::Files, done: i + 1, total: root.buffers.len(), item: &at })?;
    }
    Ok(buffers)
}
