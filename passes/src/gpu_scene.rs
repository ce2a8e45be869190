//! The scene on the GPU, and each camera's view of it.
//!
//! | module | content |
//! | --- | --- |
//! | [`upload`] | buffers and textures of meshes, materials and the environment |
//! | [`view`] | a camera's view: matrices, visible instances, uniforms |
//! | [`draws`], [`draw`], [`indirect`] | draw lists of a view, and how a pass records them |
//! | [`streams`] | vertex streams |
//! | [`punctual`] | froxel grid and lists of punctual lights |
//! | [`shadow_views`] | shadow maps fitted to a view: cascades, spot and point lights |
//! | [`lighting`] | prefiltered environment and lookup tables as bindings |
//! | [`prepared`], [`previous_view`] | data reused between views and frames |
//!
//! This folder may use [`light`](crate::light), [`program`](crate::program) and [`settings`](crate::settings); it knows no effect.

pub mod draw;
pub mod draws;
pub mod indirect;
pub mod lighting;
pub(crate) mod placements;
pub mod prepared;
pub mod previous_view;
pub mod punctual;
pub mod shadow_views;
pub mod streams;
pub mod upload;
pub mod view;
