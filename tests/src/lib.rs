//! What the tests across crates share: comparing pictures, the README's examples as tests.

pub mod compare;
pub mod files;
pub mod fuzz;
pub mod lookup;
pub mod measure;
pub mod mirror;
pub mod reference;
pub mod truth;

/// The examples of the README, run as doc tests.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;
