//! What the workspace's Rust files hold: their product code, their modules, and which file uses which.
//!
//! ```text
//! text ─ product ─> code without comments, strings and tests ─ tokens ─> words
//! words ─ module ─> what each module defines, imports and names ─ uses ─> edges between files ─ circles
//! ```
//!
//! It is no compiler: it reads names, not types. A method that is called on a value is not seen as a use of the file
//! that defines it; the path that names its type is.

pub mod circles;
pub mod literals;
pub mod module;
pub mod product;
pub mod uses;
