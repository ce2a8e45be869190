//! Reading of entire files.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

use crate::error::{Quantity, SceneError};

/// Maximum size of a file, in bytes.
pub const MAX_FILE_BYTES: u64 = 4 << 30;

/// Returns the length of a regular file in bytes. Nothing is opened: opening a pipe would wait for its writer, and
/// opening a device may have side effects.
pub(crate) fn file_bytes(path: &Path) -> Result<u64, SceneError> {
    let failed = |source: io::Error| SceneError::Read { file: path.into(), source };
    let about = fs::metadata(path).map_err(failed)?;
    if !about.is_file() {
        return Err(failed(io::Error::other("it is not a regular file")));
    }
    if about.len() > MAX_FILE_BYTES {
        let (what, value) = (Quantity::FileBytes, about.len());
        return Err(SceneError::TooLarge { file: path.into(), what, value, limit: MAX_FILE_BYTES });
    }
    Ok(about.len())
}

/// Reads an entire file of up to [`MAX_FILE_BYTES`]. Files of zero length, as in `/proc`, are not opened.
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, SceneError> {
    let failed = |source: io::Error| SceneError::Read { file: path.into(), source };
    let length = file_bytes(path)?;
    let mut bytes = Vec::with_capacity(length as usize);
    if length > 0 {
        // The file may have grown since its length was read.
        File::open(path).and_then(|file| file.take(length).read_to_end(&mut bytes)).map_err(failed)?;
    }
    Ok(bytes)
}

/// Reads the first bytes of a file, at most `most_bytes`.
pub(crate) fn read_start(path: &Path, most_bytes: u64) -> Result<Vec<u8>, SceneError> {
    let length = file_bytes(path)?.min(most_bytes);
    let mut bytes = Vec::with_capacity(length as usize);
    if length > 0 {
        let read = File::open(path).and_then(|file| file.take(length).read_to_end(&mut bytes));
        read.map_err(|source| SceneError::Read { file: path.into(), source })?;
    }
    Ok(bytes)
}
