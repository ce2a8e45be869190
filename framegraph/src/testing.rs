//! Tools for testing the compiler, behind the feature `testing`:
//!
//! - [`mod@check`]: an independent checker of plans (the *oracle*).
//! - [`generate`]: random graphs.
//! - [`mutation`]: broken plans that [`check`](crate::check()) must report.
//! - [`planted`]: packing problems with a known optimum.
//! - [`csv`]: published instances of memory packing problems.

pub mod check;
pub use framegraph_pack::{csv, planted};

pub mod generate;
pub mod mutation;
