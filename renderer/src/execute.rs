//! Execution of a plan: its steps as render and compute passes, and the recording context.

pub(crate) mod attached;
pub(crate) mod attachments;
pub(crate) mod begin_step;
pub(crate) mod blame;
pub(crate) mod cached_step;
pub(crate) mod clear;
pub(crate) mod commands;
pub(crate) mod cx;
pub(crate) mod epilogue;
pub(crate) mod error;
pub(crate) mod executor;
pub(crate) mod full_screen_resolve;
pub(crate) mod load_store;
pub(crate) mod lookup;
pub(crate) mod object_counts;
pub(crate) mod part;
pub(crate) mod prepared;
pub(crate) mod recording;
pub(crate) mod request_cache;
pub(crate) mod segments;
pub(crate) mod split_draws;
pub(crate) mod steps;
pub(crate) mod targets;
pub(crate) mod thread_balancer;
pub(crate) mod threads;
pub(crate) mod uniforms;
