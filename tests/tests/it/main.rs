//! Tests across crates, one binary.

mod cases;
mod frame_counts;
mod picture;
mod readme;
mod stage;
