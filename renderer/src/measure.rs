//! Times of steps and frames on the CPU and the GPU, as statistics and frame by frame.

pub(crate) mod statistics;
pub(crate) mod timestamp_queries;
pub(crate) mod timing;
pub(crate) mod trace;
