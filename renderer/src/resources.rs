//! Textures, buffers and views behind the resources of a plan: pools, histories, imports.

pub(crate) mod history;
pub(crate) mod imports;
pub(crate) mod no_memory;
pub(crate) mod physical;
pub(crate) mod pool;
pub(crate) mod pooled;
pub(crate) mod realize;
pub(crate) mod requests;
pub(crate) mod support;
pub(crate) mod views;
