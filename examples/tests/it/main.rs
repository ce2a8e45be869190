//! The programs as their users run them.

mod bad_input;
mod looking;
mod plan;
