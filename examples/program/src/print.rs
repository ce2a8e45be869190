//! Standard output and standard error, which may be closed, full, or what an output file goes to.
//!
//! Nothing here fails where it is called: work and files come first. What standard output could not take is remembered, and
//! [`exit`] says so once, at the end.

use std::fmt::Display;
use std::io::{self, ErrorKind, Write};
use std::process::ExitCode;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// The first failure of standard output.
static FAILED: Mutex<Option<io::Error>> = Mutex::new(None);
/// Standard output holds a file of the run, so that words go elsewhere.
static DIVERTED: AtomicBool = AtomicBool::new(false);

/// From now on what is printed goes to standard error: standard output takes a file.
pub fn divert() {
    DIVERTED.store(true, Ordering::Relaxed);
}

/// Prints a text as it is.
pub fn print(text: impl Display) {
    if DIVERTED.load(Ordering::Relaxed) {
        // What cannot be shown must not stop the work.
        let _ = write!(io::stderr().lock(), "{text}");
        return;
    }
    keep_first(|out| write!(out, "{text}"));
}

/// Prints a line.
pub fn line(text: impl Display) {
    print(format_args!("{text}\n"));
}

/// Shows lines on standard error, if that can be done; names in them have no control characters there.
pub fn note(text: impl Display) {
    // What cannot be shown must not stop the work.
    let mut stderr = io::stderr().lock();
    for line in text.to_string().lines() {
        let escaped = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.to_string() };
        let _ = writeln!(stderr, "{}", line.chars().map(escaped).collect::<String>());
    }
}

/// Shows a message as one line, `error: …`, on standard error.
pub fn error(message: impl Display) {
    note(format_args!("error: {}", message.to_string().replace(['\n', '\r'], " ")));
}

/// The exit code of a run that comes to `code`. A closed standard output is no fault: its reader has seen enough. A full
/// one is: a line says so, and `code` 0 becomes 2, as for any output that cannot be written.
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

/// The exit code of a program that did its work, 0, or did not, 1, of which a line on standard error says why.
pub fn ended(program: &str, result: Result<(), impl Display>) -> ExitCode {
    match result {
        Ok(()) => exit(0),
        Err(reason) => {
            note(format_args!("{program}: {reason}"));
            exit(1)
        }
    }
}

/// Refuses what stands on the command line of a program that takes nothing.
///
/// # Errors
/// One line that names the first word.
pub fn no_arguments() -> Result<(), String> {
    std::env::args_os().nth(1).map_or(Ok(()), |word| Err(format!("{}: no argument is taken", word.to_string_lossy())))
}

/// Writes, unless that has failed before.
fn keep_first(write: impl FnOnce(&mut io::StdoutLock<'_>) -> io::Result<()>) {
    let mut failed = FAILED.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
    if failed.is_none() {
        *failed = write(&mut io::stdout().lock()).err();
    }
}
