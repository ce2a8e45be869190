//! Passes of a physically based frame, modeled on Filament, for the render graph of `framegraph`.
//!
//! The crate has shadow maps, ambient occlusion, screen-space reflections, physically based shading with image-based
//! light, transparency, TAA, depth of field, bloom and color grading. Each effect is a set of render-graph passes.
//! [`standard`] declares all of them as one frame.
//!
//! # When to use it
//!
//! - To render a scene to a window or to a texture with Filament's quality and settings.
//! - To start from a complete frame, and insert or replace [stages](mod@stages) by name.
//! - To use single effects in your own graph. A pass is a plain struct that declares its inputs and records its draws.
//!
//! Use `framegraph-wgpu` alone if you have your own shading and need only an executor. Use `framegraph` alone on a
//! graphics API other than wgpu. The crate has no window, no entity system and no asset pipeline.
//!
//! # Example
//!
//! This program renders a built-in scene to a texture without a window, and reads the texture back.
//! `SceneLoop` in [`frame`] does all of it with one call, for a texture or a window.
//!
//! ```no_run
//! # #[cfg(feature = "ibl")]
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use framegraph::{Extent, Format, Options, Plan, Scratch, Target, TextureDesc, compile};
//! use framegraph_passes::gpu_scene::view::Background;
//! use framegraph_passes::{CameraView, Lighting, Settings, ViewSettings, World, standard};
//! use framegraph_scene::environment::Sky;
//! use framegraph_scene::{Scene, progress};
//! use framegraph_wgpu::{AdapterRequest, Executor, Frame, Gpu, Imports, read_texture};
//!
//! let size_px = [640, 360];
//! let gpu = Gpu::open(&AdapterRequest::from_env())?;
//!
//! // The scene, its light and one view.
//! let scene = Scene::open("columns", &mut progress::silent)?;
//! let environment = Sky::default().environment(128)?;
//! let lighting = Lighting::with_defaults(&gpu, &environment)?;
//! let settings = Settings::DEFAULT.for_scene(&scene, size_px);
//! let camera = scene.default_camera(f64::from(size_px[0]) / f64::from(size_px[1]));
//! let view_settings = ViewSettings { camera, size_px, ..ViewSettings::default() };
//! let view = CameraView::new(&scene, &lighting.image, &Background::Environment, &view_settings);
//! let world = World::new(&gpu, &scene, lighting, [view], &mut progress::silent)?;
//!
//! // The frame: declared and compiled once, executed as often as needed.
//! let mut frame = Frame::<World>::new();
//! let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb);
//! let output = frame.graph_mut().texture("output", desc);
//! let picture = standard(&mut frame, &settings, Target::from(output))?.output;
//! frame.graph_mut().readback(picture)?;
//! let mut plan = Plan::new();
//! let options = Options::for_frame(size_px[0], size_px[1]);
//! compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
//!
//! let mut executor = Executor::new(&gpu);
//! executor.execute(&plan, &frame, &world, &Imports::new())?;
//! let texture = executor.texture(&plan, picture).ok_or("the frame has no picture")?;
//! let rgba = read_texture(&gpu, texture)?.rgba8();
//! # let _ = rgba;
//! # Ok(())
//! # }
//! # #[cfg(not(feature = "ibl"))]
//! # fn main() {}
//! ```
//!
//! # Modules
//!
//! | module | content |
//! | --- | --- |
//! | [`frame`] | the standard frame, its settings, and the [`World`] that its passes read |
//! | [`stages`](mod@stages) | named stages, and the slots through which stages pass textures on |
//! | [`effects`] | the passes, with a folder or file for each effect |
//! | [`gpu_scene`] | the scene on the GPU, and each camera's view of it |
//! | [`light`] | prefiltered environments, the sun, and settings of shading |
//! | [`grading`] | color grading, compiled into lookup tables |
//! | [`feature_culling`] | drops effects that a scene does not need, with a bound on the change of the picture |
//! | [`quality`] | presets and time budgets, derived from measured time and error |
//! | [`program`] | shaders with their bindings and pipelines |
//! | [`settings`] | numeric precision, frame index, and parsing of options |
//! | [`error`] | errors of recording a pass |
//!
//! # The world
//!
//! Recorders read a *world*: application data that the executor hands to every pass. A pass asks for the parts that it
//! uses, as in `impl<W: AsRef<Programs>> Record<W> for Fxaa`. [`World`] has all parts. An application with data of its
//! own implements the same `AsRef` traits.
//!
//! | part | content | used by |
//! | --- | --- | --- |
//! | [`Programs`](program::Programs) | shaders with their bindings | all passes |
//! | [`FrameIndex`] | index of the frame | post-processing |
//! | [`GradingTables`](grading::GradingTables) | color grading tables, created on demand | post-processing |
//! | [`Views`](gpu_scene::view::Views) | cameras, suns, draw lists, transforms of instances | passes that draw the scene |
//! | [`GpuScene`](gpu_scene::upload::GpuScene) | meshes, materials, textures | passes that draw the scene |
//! | [`Lighting`] | image-based light and its lookup tables | color, transparent |
//!
//! # Features
//!
//! - `ibl` (default): prefilters environments and computes the DFG table, with a cache on disk. Without it,
//!   [`Lighting`] is plain data, to be filled with light that was prefiltered elsewhere.
//! - `files`: settings files, and the standard passes as plugins of graph files.

#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(test)]
mod adapter;
pub mod effects;
pub mod error;
pub mod feature_culling;
pub mod frame;
pub mod gpu_scene;
pub mod grading;
pub mod light;
pub mod program;
pub mod quality;
pub mod settings;
pub mod stages;

pub use effects::bloom::BloomSettings;
pub use effects::dof::DofSettings;
pub use effects::fog::FogSettings;
pub use effects::occlusion::OcclusionSettings;
pub use effects::picking::{Pick, Pickable, Picker};
pub use effects::post::PostSettings;
pub use effects::reflection::ReflectionSettings;
pub use effects::taa::TaaSettings;
pub use effects::transparency::Transparency;
pub use effects::upscale::Upscale;
pub use error::PassError;
pub use feature_culling::{Effect, EffectSet, FactInput, FactMemory, Facts};
pub use frame::frame_settings::FrameSettings;
pub use frame::world::World;
pub use frame::{FrameIo, Settings, StandardWorld, stages, standard};
pub use gpu_scene::lighting::Lighting;
pub use gpu_scene::prepared::PreparedScene;
pub use gpu_scene::punctual::LightSearch;
pub use gpu_scene::view::{CameraView, ViewId, ViewSettings};
pub use light::shading::{Quality, Shading};
pub use quality::preset::Preset;
pub use settings::frame_index::FrameIndex;
pub use settings::key_value::OptionError;
pub use settings::precision::Precision;
pub use settings::table::SettingsTable;
pub use stages::{Handles, Slot, Stage, StageError};
