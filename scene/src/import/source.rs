//! A parsed file with its bytes: what every part of the importer reads from.

use std::borrow::Cow;
use std::cell::Cell;
use std::path::Path;

use gltf_json::Root;

use super::limits::MAX_DECODED_BYTES;
use crate::error::{Quantity, SceneError, one_line};

/// The document, its buffers, and how much was decoded from them so far.
pub(super) struct Source<'a> {
    /// The file, for messages and for paths relative to it.
    pub file: &'a Path,
    /// The JSON as the schema types have it. Indices in it are unchecked.
    pub root: &'a Root,
    /// The bytes of each buffer, at least as long as the JSON says.
    pub buffers: Vec<Cow<'a, [u8]>>,
    decoded_bytes: Cell<u64>,
}

impl<'a> Source<'a> {
    pub fn new(file: &'a Path, root: &'a Root, buffers: Vec<Cow<'a, [u8]>>) -> Self {
        Self { file, root, buffers, decoded_bytes: Cell::new(0) }
    }

    /// An error at a place in this file.
    pub fn malformed(&self, at: &str, reason: impl Into<String>) -> SceneError {
        SceneError::malformed(self.file, at, reason)
    }

    /// An error about something in this file that is over its limit.
    pub fn too_large(&self, what: Quantity, value: u64, limit: u64) -> SceneError {
        SceneError::TooLarge { file: self.file.into(), what, value, limit }
    }

    /// Counts `bytes` about to be decoded, and refuses once they exceed [`MAX_DECODED_BYTES`].
    pub fn charge(&self, bytes: u64) -> Result<(), SceneError> {
        let sum = self.decoded_bytes.get().saturating_add(bytes);
        if sum > MAX_DECODED_BYTES {
            return Err(self.too_large(Quantity::DecodedBytes, sum, MAX_DECODED_BYTES));
        }
        self.decoded_bytes.set(sum);
        Ok(())
    }

    /// The bytes of a buffer view and its stride, if it states one.
    pub fn view(&self, index: usize, at: &str) -> Result<(&[u8], Option<usize>), SceneError> {
        let views = &self.root.buffer_views;
        let view = views.get(index).ok_or_else(|| self.malformed(at, beyond("buffer view", index, views)))?;
        let buffer = view.buffer.value();
        let data =
            self.buffers.get(buffer).ok_or_else(|| self.malformed(at, beyond("buffer", buffer, &self.buffers)))?;
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let length = view.byte_length.0;
        let bytes = slice(data, start, length).ok_or_else(|| {
            self.malformed(
                at,
                format!(
                    "buffer view {index} covers {length} bytes from {start}, but buffer {buffer} \
                     has {}",
                    data.len()
                ),
            )
        })?;
        Ok((bytes, view.byte_stride.map(|s| s.0).filter(|s| *s > 0)))
    }
}

/// `length` bytes from `start`, if the slice has them. Takes the file's 64-bit numbers as they are.
pub(super) fn slice(data: &[u8], start: u64, length: u64) -> Option<&[u8]> {
    let end = start.checked_add(length)?;
    data.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?)
}

/// The reason for an index that is too large.
pub(super) fn beyond<T>(what: &str, index: usize, all: &[T]) -> String {
    format!("names {what} {index}, but there are {}", all.len())
}

/// Warnings of one load, each once.
pub(super) struct Warnings {
    file: String,
    lines: Vec<String>,
}

impl Warnings {
    pub fn new(file: &Path) -> Self {
        Self { file: one_line(&file.display().to_string()), lines: Vec::new() }
    }

    /// Adds `text` after the file's name, unless it was said before. After 100 only their number
    /// would help, so no more are kept.
    pub fn push(&mut self, text: impl AsRef<str>) {
        const MOST: usize = 100;
        let line = format!("{}: {}", self.file, one_line(text.as_ref()));
        if self.lines.contains(&line) || self.lines.len() > MOST {
            return;
        }
        if self.lines.len() == MOST {
            self.lines.push(format!("{}: further warnings are left out", self.file));
        } else {
            self.lines.push(line);
        }
    }

    pub fn into_lines(self) -> Vec<String> {
        self.lines
    }
}
