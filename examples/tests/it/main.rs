//! The programs as their users run them.

mod bad_input;
mod lighting;
mod looking;
mod outputs;
mod scene_files;
mod stages;
mod support;
