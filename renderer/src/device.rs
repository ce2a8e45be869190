//! The device: adapter selection, capabilities, error reporting and readback.

pub(crate) mod adapter;
pub(crate) mod attached_layers;
pub(crate) mod caps;
pub(crate) mod draw_texel;
pub(crate) mod error;
pub(crate) mod format;
pub(crate) mod gpu;
pub(crate) mod open_error;
pub(crate) mod pipeline_cache;
pub(crate) mod pixels;
pub(crate) mod readback;
pub(crate) mod rounding;
pub(crate) mod window_surface;
