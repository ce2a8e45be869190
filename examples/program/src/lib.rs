//! What the command-line programs of this repository share.
//!
//! - [`print`](mod@print): standard output and standard error, written without a panic when they are closed or full.
//! - [`outputs`] (feature `run`): the files that a run writes, checked before the work and put in place together after it.
//! - [`input`]: files that are read, which are regular ones.
//! - [`interrupt`] (feature `run`): SIGINT and SIGTERM as a question that long work asks at each step.
//! - [`bytes`](fn@crate::bytes) (feature `run`): numbers of bytes as users write them.
//! - [`budget`] (feature `budget`): limits on what a plan may cost.
//! - [`progress`] (feature `run`): how far the work is, on standard error.

#[cfg(feature = "budget")]
pub mod budget;
#[cfg(feature = "run")]
mod bytes;
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

#[cfg(feature = "run")]
pub use bytes::bytes;
pub use print::{ended, error, exit, line, no_arguments, note, print};
