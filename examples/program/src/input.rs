//! Files that a run reads: regular ones alone, since a pipe would wait for its writer and a device may have no end.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;

/// Opens a file for reading.
///
/// # Errors
/// What the system refuses; that it is not a regular file.
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

/// The text of a file of at most so many bytes.
///
/// # Errors
/// One line that names the file and what is wrong with it, with the place where that is a line.
pub fn text(path: &Path, most_bytes: u64) -> Result<String, String> {
    let shown = path.display();
    let unreadable = |error: io::Error| format!("{shown}: cannot be read: {error}");
    // Some files say that they have no length.
    let mut bytes = Vec::new();
    open(path).map_err(unreadable)?.take(most_bytes.saturating_add(1)).read_to_end(&mut bytes).map_err(unreadable)?;
    if bytes.len() as u64 > most_bytes {
        return Err(format!("{shown}: more than {most_bytes} bytes; files of that size are not read"));
    }
    in_utf8(path, bytes)
}

/// The bytes of a file as text.
///
/// # Errors
/// One line that names the file and the line that is none.
pub fn in_utf8(path: &Path, bytes: Vec<u8>) -> Result<String, String> {
    String::from_utf8(bytes).map_err(|error| {
        let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
        let line = 1 + before.iter().filter(|byte| **byte == b'\n').count();
        format!("{}:{line}:1: the line is not UTF-8; save the file as UTF-8", path.display())
    })
}

/// Texts that describe a frame, a device or settings are read up to so many bytes.
pub const MOST_TEXT_BYTES: u64 = 64 << 20;
