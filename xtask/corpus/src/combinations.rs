//! Combinations of effects, options and parts of scenes: a covering array of them, each case rendered by its own process.
//!
//! # Map
//! - [`cover`]: covering arrays of any factors.
//! - [`factors`]: the factors of frames and scenes, and the pairs that exclude each other.
//! - [`scene`]: small scenes of any parts.
//! - [`run`](fn@run): all cases, on several cores.

pub mod cover;
pub mod factors;
mod run;
pub mod scene;

pub use run::{Options, Outcome, Rendered, run};
