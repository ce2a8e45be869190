//! The frame of Filament as render-graph pass plugins.
//!
//! Each pass is a folder or file: its inputs and parameters as fields, what it touches ([`framegraph::Pass`]), what it
//! draws ([`framegraph_wgpu::Record`]), its tests. [`frame::standard`] composes them into one graph; [`World`] is what recorders
//! are handed: the scene on the GPU, its [`Lighting`], the view, and the shaders. [`Shading`] says how surfaces are shaded.
//!
//! ```text
//! shadow ──┐
//! prepass ─┼─> color (opaque, sky, blended) ──> post ──> fxaa ──> output
//!          └─> or, where the scene transmits: color ──> scene/… ──> transparent ──> post
//! ```

pub mod color;
pub mod draw;
pub mod effect;
pub mod frame;
pub mod fxaa;
pub mod ibl;
pub mod lighting;
pub mod post;
pub mod precision;
pub mod prepass;
pub mod program;
pub mod shading;
pub mod shadow;
pub mod transmission;
pub mod upload;
pub mod view;
pub mod world;

pub use frame::{FrameIo, Settings, standard};
pub use lighting::Lighting;
pub use precision::Precision;
pub use shading::{Quality, Shading};
pub use view::{View, ViewSettings};
pub use world::World;
