//! Contents of random graphs: the work of each pass, derived from its declaration, and a CPU simulation of it.
//!
//! Executors record the work that [`spec`] and [`copy`] define, with the shaders of [`shader`], and compare what is left
//! in memory with [`oracle`].

#![allow(missing_docs, reason = "used by tests only")]

pub mod code;
pub mod copy;
pub mod oracle;
mod oracle_copy;
pub mod shader;
pub mod spec;

pub use framegraph_check::generate::FRAME;
