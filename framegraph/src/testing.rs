//! What tests, proofs and fuzzing of the compiler are made of, and a program that renders does without: the independent
//! oracle of plans ([`mod@check`]), random graphs ([`generate`]), plans broken on purpose to see whether
//! [`check`](crate::check()) notices ([`mutation`]), packings whose lowest top is known ([`planted`]), and the tables in
//! which instances of memory packing are published ([`csv`]). Behind the feature `testing`.

pub mod check;
pub use framegraph_pack::{csv, planted};

pub mod generate;
pub mod mutation;
