//! Tests across crates, one binary.

mod bisect;
mod cases;
mod documents;
mod executed;
mod frame_counts;
mod frames;
mod furnace;
mod half;
mod inline;
mod inspect;
mod light;
mod lobes;
mod mirrors;
mod parts;
mod picture;
mod proofs;
mod readme;
mod reference;
mod shadows;
mod stage;
mod transmission;
mod views;
