//! Where results go.

use std::fs;
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Writes to the file, or to standard output when there is none.
///
/// # Errors
/// One line that names the file and what the system says.
pub fn write(out: Option<&Path>, text: &str) -> Result<(), String> {
    match out {
        None => print(text),
        Some(path) => write_file(path, text).map_err(|e| format!("{}: cannot be written: {e}", path.display())),
    }
}

/// Prints to standard output. A reader that has seen enough and closed the pipe is no error.
///
/// # Errors
/// What the system says.
pub fn print(text: &str) -> Result<(), String> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(format!("standard output: {error}")),
        _ => Ok(()),
    }
}

/// Whole or not at all: into a file beside it, which then takes its name.
fn write_file(path: &Path, text: &str) -> std::io::Result<()> {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.part", std::process::id()));
    let part: PathBuf = path.with_file_name(name);
    let written = fs::write(&part, text).and_then(|()| fs::rename(&part, path));
    if written.is_err() {
        // The first error is the one to report; what is left of the part is of no use.
        let _ = fs::remove_file(&part);
    }
    written
}
