//! `cargo xtask demo` and `cargo xtask test`: set a fresh machine up, then run.
//!
//! The program depends on the standard library and on how programs here print, so it builds in a second or two even where
//! nothing else has been built yet. It starts `cargo` for the rest.
//!
//! # Map
//! - [`command`]: a command a file. To add one, write the file and name it in [`command::ALL`].
//! - [`adapter`]: is there a GPU or software driver, and if not, which packages bring one.
//! - [`lints`]: this program in the place of the compiler, to lint and document what it compiles.
//! - [`mutant`]: faults planted in sources, to see whether a test falls.
//! - [`prose`]: style check of documentation, comments and messages.
//! - [`source`]: the Rust files of the rooms: product code, modules, circles.
//! - [`rustc_time`]: this program in the place of the compiler, to time crates.
//! - [`stage`]: run one child process, time it, say how it ended.
//! - [`tally`]: what the tests reported: totals, skips, adapters.
//!
//! # Exit codes
//! 0 done; 1 something failed; 2 the command line was wrong.

mod adapter;
mod command;
mod lints;
mod mutant;
mod options;
mod prose;
mod rustc_time;
mod source;
mod stage;
mod tally;
#[cfg(test)]
mod tree;
mod workspace;

use std::fmt;
use std::process::ExitCode;

use options::Request;

/// Why a command did not do what it was asked for; shown as one line.
#[derive(Debug, PartialEq, Eq)]
enum Failure {
    /// The command line was wrong: exit code 2.
    Usage(String),
    /// The work was tried and failed: exit code 1.
    Failed(String),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(reason) => write!(f, "{reason}; `cargo xtask --help` lists what there is"),
            Self::Failed(reason) => f.write_str(reason),
        }
    }
}

fn main() -> ExitCode {
    if let Some(log) = std::env::var_os(rustc_time::LOG) {
        return rustc_time::wrap(std::env::args_os().skip(1), &log);
    }
    if let Some(document) = std::env::var_os(lints::DOCUMENT) {
        return lints::wrap(std::env::args_os().skip(1), &document);
    }
    match run() {
        Ok(()) => program::exit(0),
        Err(failure) => {
            program::note(format_args!("xtask: {failure}"));
            program::exit(match failure {
                Failure::Usage(_) => 2,
                Failure::Failed(_) => 1,
            })
        }
    }
}

/// Reads the command line and does what it asks for.
fn run() -> Result<(), Failure> {
    match options::parse(std::env::args_os().skip(1), command::ALL)? {
        Request::Help(None) => program::print(options::help(command::ALL)),
        Request::Help(Some(command)) => program::print(options::help_of(command)),
        Request::Run(command, options) => return (command.run)(&options),
    }
    Ok(())
}
