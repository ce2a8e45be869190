//! Code shared by the command-line programs of this repository.
//!
//! - [`print`](mod@print): standard output and standard error without panics when they are closed or full.
//! - [`outputs`] (feature `run`): output files, checked before the work and renamed into place together after it.
//! - [`input`]: input files, which must be regular files.
//! - [`interrupt`] (feature `run`): SIGINT and SIGTERM as a flag that long work polls at each step.
//! - [`cli`] (feature `cli`): command lines.
//! - [`progress`] (feature `run`): progress on standard error.

#[cfg(feature = "cli")]
pub mod cli;
pub mod input;
#[cfg(feature = "run")]
pub mod interrupt;
#[cfg(feature = "run")]
pub mod outputs;
#[cfg(feature = "run")]
mod part;
#[cfg(feature = "run")]
mod place;
pub mod print;
#[cfg(feature = "run")]
pub mod progress;
#[cfg(feature = "run")]
mod target;

#[cfg(feature = "cli")]
pub use clap;
pub use print::{ended, error, exit, line, no_arguments, note, print};
