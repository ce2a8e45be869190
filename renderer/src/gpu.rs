//! The wgpu back end: one responsibility a file.
//!
//! [`Gpu`] is an opened device, [`Executor`] executes plans on it, [`Cx`] is what recorders work with. Everything else
//! serves these three.

mod adapter;
mod attachments;
mod bindings;
mod bound;
mod caps;
mod cx;
mod device;
mod epilogue;
mod error;
mod executor;
mod fill;
mod format;
mod hash;
mod history;
mod imports;
mod layers;
mod lookup;
mod objects;
mod ops;
mod pipeline_key;
mod pipeline_state;
mod pipelines;
mod poison;
mod pool;
mod probe;
mod readback;
mod realize;
mod requests;
mod rounding;
mod samplers;
mod samples;
mod shader;
mod shape;
mod stamps;
mod steps;
mod support;
mod targets;
mod texels;
mod timing;
mod trace;
mod trouble;
mod uniforms;
mod views;

pub use adapter::{AdapterRequest, describe, is_software, rank};
pub use bindings::Binding;
pub use bound::{Bound, BoundBuffer, ViewPart};
pub use caps::caps_of;
pub use cx::Cx;
pub use device::{Gpu, OpenError};
pub use epilogue::{Effect, Epilogue, Inlined};
pub use error::{ExecuteError, RecordError};
pub use executor::{Executor, ExecutorOptions, UnusedAccess};
pub use format::{buffer_usages, format_of, texture_format, texture_usages};
pub use imports::{ImportError, Imports};
pub use objects::ObjectCounts;
pub use pipeline_state::{Compute, Constants, Depth, Output, Raster, VertexBuffer};
pub use pipelines::{ComputePipeline, Pipeline, RasterPipeline};
pub use pool::PoolCounts;
pub use readback::{Readback, ReadbackError, Subresource, read_buffer, read_texture};
pub use rounding::{Rounding, RoundingError, StoreRounding};
pub use samplers::SamplerShape;
pub use samples::{Samples, Summary};
pub use shader::{Shader, ShaderError};
pub use support::{Unsupported, fallback, is_filterable, supported_format};
pub use targets::Targets;
pub use texels::Pixels;
pub(crate) use texels::srgb_from_linear;
pub use timing::{Times, Timing};
pub use trace::Trace;
pub use trouble::{DeviceError, Scopes, Trouble};
pub use views::CacheCounts;

pub(crate) use steps::Extra;
