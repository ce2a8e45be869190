//! Where results go.

use program::outputs::Outputs;
use std::path::Path;

/// The files of a run: `out` is checked before the work, and never one of those that are read.
///
/// # Errors
/// One line that names the file and what is against it.
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

/// Writes to the file, or to standard output when there is none.
///
/// # Errors
/// One line that names the file and what the system says.
pub fn write(mut outputs: Outputs, out: Option<&Path>, text: &str) -> Result<(), String> {
    let Some(path) = out else {
        program::print(text);
        return Ok(());
    };
    outputs.write(path, |file| file.write_all(text.as_bytes())).map_err(|error| error.to_string())?;
    outputs.commit().map(drop).map_err(|error| error.to_string())
}
