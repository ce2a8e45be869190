//! Executes render graphs on wgpu.
//!
//! The crate [`framegraph`] compiles a graph of passes to a [`Plan`](framegraph::Plan). This crate executes plans: it creates
//! textures and buffers, begins render and compute passes, calls the recorders of the application, and submits the commands.
//! It also measures GPU times, and reads any intermediate texture back for debugging.
//!
//! # When to use it
//!
//! Use this crate if a frame has several passes that depend on each other, and if any of these matters:
//!
//! - Load and store operations should be derived instead of written by hand.
//! - Intermediate textures should share memory, or never leave tile memory.
//! - Passes come and go at run time, for example with the settings of the user.
//! - Intermediate results should be inspected, and every pass should be timed.
//!
//! Plain wgpu is simpler for a few passes that never change. The crate [`framegraph`] alone is enough if another API
//! executes the plan, since it does not depend on wgpu. This crate does not use async compute, because wgpu has a
//! single queue.
//!
//! # Example
//!
//! A pass declares the resources it accesses, and records its commands. This example runs without a GPU, on wgpu's noop
//! backend. Applications open a device with [`Gpu::open`], or share their own with [`Gpu::wrap`].
//!
//! ```
//! use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, Options, Pass, PassBuilder, Plan, Scratch};
//! use framegraph::{Texture, TextureDesc, View};
//! use framegraph_wgpu::{Cx, Executor, Frame, Gpu, Imports, Raster, Record, RecordError, Shader};
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
//! /// Inverts an image.
//! struct Invert {
//!     image: Texture,
//! }
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
//! let gpu = Gpu::noop()?;
//!
//! // Declare the frame: a cleared texture, and the pass that inverts it.
//! let mut frame = Frame::<()>::new();
//! let black = frame.graph_mut().texture("black", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
//! let clear = Intent::Clear(ClearValue::BLACK);
//! let image = frame.add_fn("clear", |pass| pass.color(black, clear), |_, _, _| Ok(()))?;
//! let (_, inverted) = frame.add("invert", Invert { image })?;
//! frame.graph_mut().export(inverted)?;
//!
//! // Compile and execute it.
//! let (mut plan, mut scratch) = (Plan::new(), Scratch::new());
//! framegraph::recompile(frame.graph(), &gpu.caps(), &Options::for_frame(64, 64), &mut scratch, &mut plan)?;
//! let mut executor = Executor::new(&gpu);
//! executor.execute(&plan, &frame, &(), &Imports::new())?;
//! assert_eq!(executor.executed(), plan.counts());
//! # Ok(())
//! # }
//! ```
//!
//! [`FrameLoop`] combines frame, plan and executor for programs that declare the frame every time.
//!
//! # Overview
//!
//! | Type | Purpose |
//! | --- | --- |
//! | [`Gpu`] | a wgpu device with its queue, limits and errors |
//! | [`Frame`] | a declared graph with a recorder for each pass |
//! | [`Record`] | trait of executable passes |
//! | [`Cx`] | context of a recorder: views, pipelines, bind groups, uniforms |
//! | [`Executor`] | executes plans; owns pools, caches and histories |
//! | [`FrameLoop`] | declares, compiles and executes one frame after the other |
//! | [`Imports`] | textures and buffers of the application, such as the image of a [`WindowSurface`] |
//! | [`Timing`], [`Trace`] | CPU and GPU times of frames and steps |
//! | [`Readback`], [`read_texture`], [`read_buffer`] | readback of textures and buffers |
//! | [`Epilogue`] | a point-wise pass that runs at the end of another pass's fragment shader |
//!
//! | Module | Contents |
//! | --- | --- |
//! | [`frame`] | declared frames |
//! | [`inspect`] | inspection of any texture of a frame, as numbers and as an image |
//! | [`debug`] | debug modes, and a bisection that finds the mode that changes an image |
//! | `remote` | server in an engine that viewers attach to (feature `remote`) |
//! | `mock` | mock recorders and imports for graphs without recorders (feature `testing`) |
//!
//! # Features
//!
//! | Feature | Purpose | Default |
//! | --- | --- | --- |
//! | `vulkan`, `metal`, `dx12`, `gles` | graphics APIs, each on the systems that have it | yes |
//! | `noop` | [`Gpu::noop`], a device that validates all calls and draws nothing, for tests without a GPU | yes |
//! | `threads` | `Workers`, which record the steps of a frame on several threads | no |
//! | `files` | frames from graph files, with the feature of the same name in [`framegraph`] | no |
//! | `remote` | a server that viewers attach to, on the loopback address by default | no |
//! | `tracing` | spans of the crate `tracing` for compilations, frames, steps and passes, with counts and bytes | no |
//! | `testing` | module `mock` | no |

#![cfg_attr(docsrs, feature(doc_cfg))]

mod cache;
mod clock;
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
#[cfg(feature = "remote")]
pub mod remote;
mod resources;
mod spans;
#[cfg(feature = "threads")]
mod workers;
#[cfg(not(feature = "threads"))]
#[path = "no_workers.rs"]
mod workers;

pub use ::wgpu;

pub use cache::CacheCounts;
pub use device::adapter::{AdapterRequest, describe, is_software};
pub use device::error::{DeviceError, DeviceErrors, ErrorScopes};
pub use device::format::{buffer_usages, format_of, texture_2d, texture_format, texture_usages};
pub use device::gpu::Gpu;
pub use device::open_error::OpenError;
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
pub use execute::split_draws::SplitDraws;
pub use execute::targets::Targets;
#[doc(inline)]
pub use frame::Frame;
pub use frame_loop::{FrameError, FrameLoop, FrameOutput};
pub use frames_in_flight::FramesInFlight;
pub use measure::statistics::Summary;
pub use measure::timing::{Times, Timing};
pub use measure::trace::{FrameTimes, StepTimes, Trace};
pub use named::Named;
pub use pipelines::bind_groups::Binding;
pub use pipelines::binding_error::{BindingError, BindingReason};
pub use pipelines::loops::endless_loop;
pub use pipelines::pipeline::{ComputePipeline, Group, Pipeline, RasterPipeline};
pub use pipelines::samplers::SamplerDesc;
pub use pipelines::shader::{InterfaceChange, Shader, ShaderError};
pub use pipelines::state::{Compute, Constants, Depth, Output, Raster, VertexBuffer};
pub use placed::not_placed::NotPlaced;
pub use record::Record;
pub use resources::imports::{ImportError, ImportMismatch, Imports};
pub use resources::no_memory::NoMemory;
pub use resources::pool::PoolCounts;
pub use resources::support::{Unsupported, UnsupportedReason, supported_format};
#[cfg(feature = "threads")]
pub use workers::{Workers, WorkersError};

/// The README's example.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
