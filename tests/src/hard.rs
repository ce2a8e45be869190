//! Tests of the shader library with inputs that break arithmetic, and of each guard in it.
//!
//! [`probe`] defines inputs and invariants of functions, [`judge`] evaluates them on the device, and [`guard`] finds
//! guards and removes them. [`strict`] rewrites shaders as stricter drivers may evaluate them, and [`rows`] lists the
//! kinds of hard inputs. The program `hard_cases` prints `docs/measurements/hard-cases.md`, and a test compares the document.

pub mod document;
pub mod guard;
pub mod judge;
pub mod probe;
mod probes;
pub mod rows;
pub mod strict;
