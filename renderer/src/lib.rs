//! Executes the plans of [`framegraph`] on wgpu: device, executor, pools, pipelines, timing, inspection.
//!
//! [`frame`] is what authors of passes see, [`Executor`] executes on a [`Gpu`].
//! [`inspect`] reads any texture of a frame, [`debug`] has switches to find faults with; with the feature `testing`,
//! `mock` executes graphs that have no recorders yet.
//! A pass declares what it touches and records what it draws; nothing else is needed to run it:
//!
//! ```
//! use framegraph::{DeclareError, Extent, Format, Intent, Options, Pass, PassBuilder, Plan, Scratch, Texture, TextureDesc, View};
//! use framegraph_wgpu::{Frame, Record, Cx, Executor, Gpu, Imports, Raster, RecordError, Shader};
//!
//! const INVERT: Shader<'static> = Shader::new("invert", "
//!     @group(0) @binding(0) var image: texture_2d<f32>;
//!     @vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
//!         return vec4f(f32(i & 1) * 4.0 - 1.0, f32(i >> 1) * 4.0 - 1.0, 0.0, 1.0);
//!     }
//!     @fragment fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
//!         return 1.0 - textureLoad(image, vec2u(at.xy), 0);
//!     }");
//!
//! struct Invert { image: Texture }
//!
//! impl Pass for Invert {
//!     type Io = (View, Texture);
//!     fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Self::Io, DeclareError> {
//!         let image = pass.sampled(self.image)?;
//!         let inverted = pass.texture("inverted", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
//!         Ok((image, pass.color(inverted, Intent::Overwrite)?))
//!     }
//! }
//!
//! impl<W: ?Sized> Record<W> for Invert {
//!     fn record(&self, (image, _): &Self::Io, _: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
//!         let pipeline = cx.raster_pipeline(&Raster::new(INVERT))?;
//!         let image = cx.view(*image)?;
//!         let group = cx.bind_group(pipeline.group(0), &[(0, image.into())]);
//!         let pass = cx.render_pass()?;
//!         pass.set_pipeline(&pipeline);
//!         pass.set_bind_group(0, &group, &[]);
//!         pass.draw(0..3, 0..1);
//!         Ok(())
//!     }
//! }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let gpu = Gpu::noop()?;
//! # let desc = TextureDesc::new(Extent::absolute(64, 64), Format::Rgba8Unorm);
//! # let mut frame = Frame::<()>::new();
//! # let blank = frame.graph_mut().texture("blank", desc);
//! # let clear = Intent::Clear(framegraph::ClearValue::BLACK);
//! # let image = frame.add_fn("blank", |p| p.color(blank, clear), |_, _, _| Ok(()))?;
//! let (_, inverted) = frame.add("invert", Invert { image })?;
//! frame.graph_mut().export(inverted)?;
//! let (mut plan, mut scratch, options) = (Plan::new(), Scratch::new(), Options::for_frame(64, 64));
//! framegraph::recompile(frame.graph(), &gpu.caps(), &options, &mut scratch, &mut plan)?;
//! let mut executor = Executor::new(&gpu);
//! executor.execute(&plan, &frame, &(), &Imports::new())?;
//! assert_eq!(executor.executed(), plan.counts());
//! # Ok(())
//! # }
//! ```

mod cache;
pub mod debug;
mod device;
mod execute;
pub mod frame;
mod frame_key;
mod frame_loop;
mod frames_in_flight;
mod hash;
pub mod inspect;
mod measure;
#[cfg(feature = "testing")]
pub mod mock;
mod named;
mod pipelines;
mod placed;
mod record;
mod recorders;
mod resources;
#[cfg(feature = "threads")]
mod workers;
#[cfg(not(feature = "threads"))]
#[path = "no_workers.rs"]
mod workers;

pub use ::wgpu;

pub use cache::CacheCounts;
pub use device::adapter::{AdapterRequest, describe, is_software};
pub use device::error::{DeviceError, DeviceErrors, ErrorScopes};
pub use device::format::{buffer_usages, format_of, texture_format, texture_usages};
pub use device::gpu::{Gpu, OpenError};
pub use device::pipeline_cache::PipelineCacheError;
pub use device::pixels::Pixels;
pub use device::readback::{Readback, ReadbackError, Subresource, read_buffer, read_texture};
pub use device::rounding::{Rounding, RoundingError, StoreRounding};
pub use device::window_surface::{SurfaceError, WindowSurface};
pub use execute::commands::FrameCommands;
pub use execute::cx::Cx;
pub use execute::epilogue::{Effect, Epilogue, SettingName};
pub use execute::error::{EffectSetting, ExecuteError, MemoryRequest, PassReason, RecordError};
pub use execute::executor::{Allocated, Executor, ExecutorOptions, UnusedAccess, WarmUpProgress};
pub use execute::object_counts::ObjectCounts;
pub use execute::part::{BoundBuffer, BoundResource, HistoryImage, ViewPart};
pub use execute::targets::Targets;
pub use frame::Frame;
pub use frame_loop::{FrameError, FrameLoop, FrameOutput};
pub use frames_in_flight::FramesInFlight;
pub use measure::statistics::Summary;
pub use measure::timing::{Times, Timing};
pub use measure::trace::{FrameTimes, StepTimes, Trace};
pub use named::Named;
pub use pipelines::bind_groups::Binding;
pub use pipelines::binding_error::{BindingError, BindingReason};
pub use pipelines::bounds::unproved_index;
pub use pipelines::loops::endless_loop;
pub use pipelines::pipeline::{ComputePipeline, Group, Pipeline, RasterPipeline};
pub use pipelines::samplers::SamplerDesc;
pub use pipelines::shader::{Shader, ShaderError};
pub use pipelines::state::{Compute, Constants, Depth, Output, Raster, VertexBuffer};
pub use placed::not_placed::NotPlaced;
pub use record::Record;
pub use resources::imports::{ImportError, ImportMismatch, Imports};
pub use resources::no_memory::NoMemory;
pub use resources::pool::PoolCounts;
pub use resources::support::{Unsupported, UnsupportedReason, supported_format};
#[cfg(feature = "threads")]
pub use workers::{Workers, WorkersError};
