//! Tests across crates, one binary.

mod cases;
mod frame_counts;
mod mirrors;
mod picture;
mod readme;
mod stage;
