//! Rust files of the workspace: product code, modules, and uses between files.
//!
//! ```text
//! text ─ product ─> code without comments, strings and tests ─ tokens ─> words
//! words ─ module ─> what each module defines, imports and names ─ uses ─> edges between files ─ circles
//! ```
//!
//! It reads names, not types. A method call does not count as a use of the file that defines the method; the path that
//! names its type does.

pub mod circles;
pub mod literals;
pub mod module;
pub mod product;
pub mod uses;
