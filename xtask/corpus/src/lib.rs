//! Renders every glTF file below a folder, each in its own process with limits of time and memory, and reports the verdicts.
//!
//! `cargo xtask corpus DIR` starts the program of this package. Everything but the starting of processes is data to data.
//!
//! # Map
//! - [`args`]: the command line.
//! - [`combinations`]: combinations of effects, options and parts of scenes instead of files.
//! - [`files`]: the files below a folder.
//! - [`child`]: one process under limits, and how it ended.
//! - [`verdict`]: the verdict on a file, from how its process ended.
//! - [`record`]: results as JSON, and the state from which an interrupted run resumes.
//! - [`run`](fn@run): all files, on all cores.
//! - [`table`]: results as Markdown.
//! - [`sheet`]: results as a contact sheet; [`font`] has its letters.

pub mod args;
pub mod child;
pub mod combinations;
pub mod files;
pub mod font;
pub mod record;
mod run;
pub mod sheet;
pub mod table;
pub mod verdict;

pub use run::{Outcome, run};
