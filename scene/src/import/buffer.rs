//! Loading of buffers.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::collections::BTreeSet;

use super::source::{Buffer, Source};
use super::uri::Resource;
use crate::error::SceneError;
use crate::progress::{Progress, ProgressFn, Stage, report};
use crate::read::{file_bytes, read_file};

/// Returns the bytes of every buffer. Buffer 0 without a URI is the binary chunk `blob`; another one without a URI is
/// absent. Fallbacks of compressed buffer views are not read and stay empty.
pub(super) fn load<'a>(
    source: &Source<'_>,
    blob: Option<&'a [u8]>,
    progress: &mut ProgressFn<'_>,
) -> Result<Vec<Buffer<'a>>, SceneError> {
    let all = &source.root.buffers;
    let mut buffers = Vec::new();
    let fallbacks = fallbacks(source, blob.is_some());
    for (i, buffer) in all.iter().enumerate() {
        let at = format!("buffer {i}");
        if fallbacks.contains(&i) {
            buffers.push(Buffer::Bytes(Cow::Borrowed(&[][..])));
            continue;
        }
        let bytes: Cow<'a, [u8]> = match (&buffer.uri, blob) {
            (Some(uri), _) => match source.resolve(&at, uri)? {
                Resource::Bytes(bytes) => {
                    source.keep_file(&at, bytes.len() as u64)?;
                    Cow::Owned(bytes)
                }
                Resource::File(path) => {
                    let named = |error| source.named(&at, error);
                    source.keep_file(&at, file_bytes(&path).map_err(named)?)?;
                    source.note_file(&path);
                    Cow::Owned(read_file(&path).map_err(named)?)
                }
            },
            (None, Some(blob)) if i == 0 => Cow::Borrowed(blob),
            (None, _) => {
                buffers.push(Buffer::Absent(OnceCell::new()));
                continue;
            }
        };
        let (promised, found) = (buffer.byte_length.0, bytes.len() as u64);
        if found < promised {
            return Err(source.malformed(&at, format!("truncated: {promised} bytes are promised, {found} are there")));
        }
        buffers.push(Buffer::Bytes(bytes));
        report(progress, source.file, Progress { stage: Stage::Files, done: i + 1, total: all.len(), item: &at })?;
    }
    Ok(buffers)
}

/// Returns the buffers that hold uncompressed fallbacks of compressed views, in a build that decodes the views.
#[cfg(feature = "meshopt")]
fn fallbacks(source: &Source<'_>, has_blob: bool) -> BTreeSet<usize> {
    super::views::fallbacks(source.root, has_blob)
}

/// Returns nothing: a build without a decoder needs every buffer.
#[cfg(not(feature = "meshopt"))]
fn fallbacks(_: &Source<'_>, _: bool) -> BTreeSet<usize> {
    BTreeSet::new()
}
