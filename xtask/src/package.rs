//! Packages for crates.io: which they are, what is missing in them, and programs outside of the workspace that use them.

pub mod outside;
pub mod published;
