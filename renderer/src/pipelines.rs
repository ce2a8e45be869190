//! Pipelines, shaders, bind groups and samplers for recorders.

pub(crate) mod bind_groups;
pub(crate) mod binding_error;
pub(crate) mod cache;
mod compared_sources;
mod counting_loop;
mod interface;
pub(crate) mod key;
pub(crate) mod loops;
pub(crate) mod pipeline;
pub(crate) mod samplers;
pub(crate) mod shader;
pub(crate) mod state;
