//! `cargo xtask`: sets a fresh machine up, and runs demos, tests and measurements.
//!
//! The program depends only on the standard library and the package `program`, so it builds within two seconds. It
//! starts `cargo` for the rest.
//!
//! # Map
//! - [`command`]: one command per file. To add one, write the file and list it in [`command::ALL`].
//! - [`adapter`]: finds a GPU or software driver, or the packages that install one.
//! - [`lints`]: compiler wrapper that lints and documents.
//! - [`mutant`]: mutation testing.
//! - [`package`]: packages for crates.io.
//! - [`prose`]: style check of documentation, comments and messages.
//! - [`source`]: Rust files of the packages: product code, modules, cycles.
//! - [`rustc_time`]: compiler wrapper that times crates.
//! - [`stage`]: runs and times one child process.
//! - [`tally`]: summary of test reports: totals, skips, adapters.
//!
//! # Exit codes
//! 0: success. 1: a stage failed. 2: the command line was wrong.

mod adapter;
mod command;
mod lints;
mod mutant;
mod options;
mod package;
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

/// Reason a command failed; displayed as one line.
#[derive(Debug, PartialEq, Eq)]
enum Failure {
    /// Invalid command line: exit code 2.
    Usage(String),
    /// The command ran and failed: exit code 1.
    Failed(String),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(reason) => write!(f, "{reason}; see `cargo xtask --help`"),
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

/// Parses the command line and runs the command.
fn run() -> Result<(), Failure> {
    match options::parse(std::env::args_os().skip(1), command::ALL)? {
        Request::Help(None) => program::print(options::help(command::ALL)),
        Request::Help(Some(command)) => program::print(options::help_of(command)),
        Request::Run(command, options) => return (command.run)(&options),
    }
    Ok(())
}
