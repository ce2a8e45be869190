//! Output of results to a file or to standard output.

use program::outputs::Outputs;
use std::path::Path;

/// Registers the files of a run and checks the files `out` before any work is done.
///
/// # Errors
/// One line that names the file and the reason: an output is not writable, or it is one of the input files.
pub fn prepare<'a>(out: [Option<&Path>; 2], read: impl IntoIterator<Item = &'a Path>) -> Result<Outputs, String> {
    let mut outputs = Outputs::default();
    for path in read {
        outputs.reads(path).map_err(|error| error.to_string())?;
    }
    for out in out.into_iter().flatten() {
        outputs.add(out).map_err(|error| error.to_string())?;
    }
    Ok(outputs)
}

/// Writes `text` to `out`, or to standard output if `out` is `None`, and to the expected output `golden`.
///
/// # Errors
/// One line that names the file and the system's reason.
pub fn write(mut outputs: Outputs, out: Option<&Path>, golden: Option<&Path>, text: &str) -> Result<(), String> {
    if out.is_none() {
        program::print(text);
    }
    for path in [out, golden].into_iter().flatten() {
        outputs.write(path, |file| file.write_all(text.as_bytes())).map_err(|error| error.to_string())?;
    }
    outputs.commit().map(drop).map_err(|error| error.to_string())
}
