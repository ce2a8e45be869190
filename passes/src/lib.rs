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
//! | [`Views`](view::Views) | cameras, suns, draw lists, placement of instances | passes over a scene |
//! | [`GpuScene`](upload::GpuScene) | meshes, materials, textures | shadow, prepass, structure, color, transparent |
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
mod background;
pub mod bloom;
pub mod budget;
pub mod choice;
pub mod color;
pub mod depth_resolve;
pub mod dof;
pub mod draw;
pub mod draws;
pub mod effect;
pub mod error;
pub mod facts;
pub mod fog;
pub mod frame;
pub mod frame_index;
pub mod frame_settings;
pub mod full_screen;
pub mod fxaa;
pub mod grading;
pub mod ibl;
pub mod indirect;
pub mod lighting;
pub mod measure;
pub mod occlusion;
pub mod pick;
#[cfg(feature = "files")]
pub mod plugins;
pub mod post;
pub mod precision;
pub mod prepared;
pub mod prepass;
pub mod preset;
pub mod program;
pub mod punctual;
pub mod reflection;
#[cfg(feature = "files")]
pub mod settings_file;
pub mod shading;
pub mod shadow;
pub mod sharpen;
pub mod stages;
pub mod stand;
pub mod streams;
pub mod structure;
pub mod sun;
pub mod surface;
pub mod taa;
pub mod tone_resolve;
pub mod transmission;
pub mod transparency;
pub mod upload;
pub mod upscale;
pub mod velocity;
pub mod view;
pub mod world;

pub use bloom::BloomSettings;
pub use dof::DofSettings;
pub use error::PassError;
pub use facts::{Effect, EffectSet, FactInput, FactMemory, Facts};
pub use fog::FogSettings;
pub use frame::{FrameIo, Settings, StandardWorld, stages, standard};
pub use frame_index::FrameIndex;
pub use frame_settings::FrameSettings;
pub use lighting::Lighting;
pub use occlusion::OcclusionSettings;
pub use pick::{Pick, Pickable, Picker};
pub use post::PostSettings;
pub use precision::Precision;
pub use prepared::PreparedScene;
pub use preset::Preset;
pub use punctual::LightSearch;
pub use reflection::ReflectionSettings;
pub use shading::{Quality, Shading};
pub use stages::{Handles, Slot, Stage, StageError};
pub use taa::TaaSettings;
pub use transparency::Transparency;
pub use upscale::Upscale;
pub use view::{CameraView, ViewId, ViewSettings};
pub use world::World;
