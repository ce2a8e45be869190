//! Reading files whole.

use std::fs::File;
use std::io::{self, Read};
use std::path::Path;

use crate::error::{Quantity, SceneError};

/// The largest file that is read, in bytes.
pub const MAX_FILE_BYTES: u64 = 4 << 30;

/// Reads a whole file, up to [`MAX_FILE_BYTES`].
pub(crate) fn read_file(path: &Path) -> Result<Vec<u8>, SceneError> {
    let failed = |source: io::Error| SceneError::Read { file: path.into(), source };
    let file = File::open(path).map_err(failed)?;
    let about = file.metadata().map_err(failed)?;
    if !about.is_file() {
        return Err(failed(io::Error::other("it is not a regular file")));
    }
    if about.len() > MAX_FILE_BYTES {
        let (what, value) = (Quantity::FileBytes, about.len());
        return Err(SceneError::TooLarge { file: path.into(), what, value, limit: MAX_FILE_BYTES });
    }
    let mut bytes = Vec::with_capacity(about.len() as usize);
    // The file may have grown since it was measured.
    file.take(MAX_FILE_BYTES).read_to_end(&mut bytes).map_err(failed)?;
    Ok(bytes)
}
