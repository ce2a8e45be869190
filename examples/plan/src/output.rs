//! Output of results to a file or to standard output.

use program::outputs::Outputs;
use std::path::Path;

/// Registers the files of a run and checks `out` before any work is done.
///
/// # Errors
/// One line that names the file and the reason: `out` is not writable, or it is one of the input files.
pub fn prepare<'a>(out: Option<&Path>, read: impl IntoIterator<Item = &'a Path>) -> Result<Outputs, String> {
    let mut outputs = Outputs::default();
    for path in read {
        outputs.reads(path).map_err(|error| error.to_string())?;
    }
    if let Some(out) = out {
        outputs.add(out).map_err(|error| error.to_string())?;
    }
    Ok(outputs)
}

/// Writes `text` to `out`, or to standard output if `out` is `None`.
///
/// # Errors
/// One line that names the file and the system's reason.
pub fn write(mut outputs: Outputs, out: Option<&Path>, text: &str) -> Result<(), String> {
    let Some(path) = out else {
        program::print(text);
        return Ok(());
    };
    outputs.write(path, |file| file.write_all(text.as_bytes())).map_err(|error| error.to_string())?;
    outputs.commit().map(drop).map_err(|error| error.to_string())
}
