//! Command-line programs, run as processes.

mod bad_input;
mod combinations;
#[cfg(unix)]
mod corpus_run;
mod lens;
mod lighting;
mod looking;
mod memory;
mod outputs;
mod scale;
mod scene_files;
mod stages;
mod support;
