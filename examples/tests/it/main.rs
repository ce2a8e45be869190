//! The programs as their users run them.

mod bad_input;
mod custom_pass;
mod lighting;
mod looking;
mod plan;
