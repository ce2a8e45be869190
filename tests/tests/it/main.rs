//! Tests across crates, one binary.

mod frame_counts;
mod picture;
mod readme;
mod stage;
