//! Standard output and standard error, which may be closed, full, or the destination of an output file.
//!
//! Printing never fails at the call, because work and files come first. [`exit`] reports a failure of standard output
//! once, at the end.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// First failure of standard output.
static FAILED: Mutex<Option<io::Error>> = Mutex::new(None);
/// Set while standard output carries a file of the run, so that messages go to standard error.
static DIVERTED: AtomicBool = AtomicBool::new(false);

/// Sends all later text to standard error, because standard output carries a file.
pub fn divert() {
    DIVERTED.store(true, Ordering::Relaxed);
}

/// Prints text without a line break.
pub fn print(text: impl Display) {
    if DIVERTED.load(Ordering::Relaxed) {
        // Failing to print must not stop the work.
        let _ = write!(io::stderr().lock(), "{text}");
        return;
    }
    keep_first(|out| write!(out, "{text}"));
}

/// Prints a line.
pub fn line(text: impl Display) {
    print(format_args!("{text}\n"));
}

/// Prints lines on standard error, with control characters escaped. Failures are ignored.
pub fn note(text: impl Display) {
    // Failing to print must not stop the work.
    let mut stderr = io::stderr().lock();
    for line in text.to_string().lines() {
        let escaped = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.to_string() };
        let _ = writeln!(stderr, "{}", line.chars().map(escaped).collect::<String>());
    }
}

/// Prints a message on standard error as one line, `error: …`.
pub fn error(message: impl Display) {
    note(format_args!("error: {}", message.to_string().replace(['\n', '\r'], " ")));
}

/// Flushes standard output and returns the exit code.
///
/// A closed standard output is not an error, since its reader needs no more. A full one is reported on standard
/// error, and turns `code` 0 into 2, as for any unwritable output.
pub fn exit(code: u8) -> ExitCode {
    keep_first(|out| out.flush());
    let failed = FAILED.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).take();
    match failed {
        Some(failure) if failure.kind() != ErrorKind::BrokenPipe => {
            error(format_args!("standard output: {failure}"));
            ExitCode::from(if code == 0 { 2 } else { code })
        }
        _ => ExitCode::from(code),
    }
}

/// Returns the exit code of a program: 0 on success, 1 on failure. A failure is reported on standard error.
pub fn ended(program: &str, result: Result<(), impl Display>) -> ExitCode {
    match result {
        Ok(()) => exit(0),
        Err(reason) => {
            note(format_args!("{program}: {reason}"));
            exit(1)
        }
    }
}

/// Rejects any argument, for a program that has none.
///
/// # Errors
/// One line that names the first argument.
pub fn no_arguments() -> Result<(), String> {
    std::env::args_os()
        .nth(1)
        .map_or(Ok(()), |word| Err(format!("{}: unexpected argument; this program takes none", word.to_string_lossy())))
}

/// Writes unless an earlier write failed.
fn keep_first(write: impl FnOnce(&mut io::StdoutLock<'_>) -> io::Result<()>) {
    let mut failed = FAILED.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if failed.is_none() {
        *failed = write(&mut io::stdout().lock()).err();
    }
}
