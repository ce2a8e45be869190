//! CPU and GPU times of steps and frames: statistics and traces.

pub(crate) mod statistics;
pub(crate) mod timestamp_queries;
pub(crate) mod timing;
pub(crate) mod trace;
