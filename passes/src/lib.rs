//! The frame of Filament as render-graph pass plugins.
//!
//! Each pass is a file: its inputs and parameters as fields, what it touches ([`framegraph::Pass`]), what it draws
//! ([`framegraph_wgpu::Record`]). A pass asks its world for the parts that it uses and no more (`impl<W: AsRef<Programs>>
//! Record<W> for Fxaa`):
//!
//! | part | what it is | who asks for it |
//! | --- | --- | --- |
//! | [`Programs`](program::Programs) | shaders with their bindings | all passes |
//! | [`FrameIndex`] | which frame it is | post |
//! | [`GradingTables`](grading::GradingTables) | tables of looks, made when they are asked for | post |
//! | [`Views`](gpu_scene::view::Views) | cameras, suns, draw lists, placement of instances | passes over a scene |
//! | [`GpuScene`](gpu_scene::upload::GpuScene) | meshes, materials, textures | shadow, prepass, structure, color, transparent |
//! | [`Lighting`] | light from all around, and its tables | color, transparent |
//!
//! [`World`] has them all. [`frame::stages`] composes the passes into named [`stages`](mod@stages), and [`standard`] declares them
//! as one graph. [`Shading`] says how surfaces are shaded.
//!
//! ```text
//! shadow ─────────────────┐
//! structure ─> occlusion ─┤
//! prepass ────────────────┼─> color (opaque, sky, blended) ──> post ──> fxaa ──> output
//!                         ├─> or, where the scene transmits: color ──> scene/… ──> transparent ──> post
//!                         └─> or, where blended surfaces need no order: color ──> blended/… ──> post
//! ```

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
pub use settings::precision::Precision;
pub use stages::{Handles, Slot, Stage, StageError};
