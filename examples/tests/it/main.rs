//! The programs as their users run them.

mod bad_input;
mod lighting;
mod looking;
mod stages;
