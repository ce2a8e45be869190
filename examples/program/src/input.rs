//! Input files of a run.
//!
//! Only regular files are read: opening a pipe blocks until it has a writer, and a device may never end.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Opens a file for reading.
///
/// # Errors
/// The system's error, or that the path is not a regular file.
pub fn open(path: &Path) -> io::Result<File> {
    let about = fs::metadata(path)?;
    if about.is_dir() {
        return Err(io::Error::other("it is a folder, not a file"));
    }
    if !about.is_file() {
        return Err(io::Error::other("it is not a regular file"));
    }
    File::open(path)
}

/// Reads a UTF-8 text file of at most `max_bytes` bytes.
///
/// # Errors
/// One line that names the file and the reason, with line and column for invalid UTF-8.
pub fn text(path: &Path, max_bytes: u64) -> Result<String, String> {
    let shown = path.display();
    let unreadable = |error: io::Error| format!("{shown}: cannot be read: {error}");
    // Special files may report a length of zero.
    let mut bytes = Vec::new();
    open(path).map_err(unreadable)?.take(max_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > max_bytes {
        return Err(format!("{shown}: larger than {max_bytes} bytes; use a smaller file"));
    }
    in_utf8(path, bytes)
}

/// Converts the bytes of a file to text.
///
/// # Errors
/// One line that names the file and the first line that is not UTF-8.
pub fn in_utf8(path: &Path, bytes: Vec<u8>) -> Result<String, String> {
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        format!("{}:{line}:1: the line is not UTF-8; save the file as UTF-8", path.display())
    })
}

/// Maximum size of a text file that describes a frame, a device or settings, in bytes.
pub const MAX_TEXT_BYTES: u64 = 64 << 20;
