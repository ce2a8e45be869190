//! Shadow maps of a view, computed on the CPU: cascades of the sun, and maps of spot and point lights that share layers.
//!
//! | file | content |
//! | --- | --- |
//! | `settings.rs`, `fields.rs` | shadow settings, in Filament's terms, and their table |
//! | `view.rs` | all maps of a view, fitted by `sun.rs` (with `splits.rs`, `volume.rs`, `warp.rs`) and `local.rs` |
//! | `atlas.rs` | placement of maps in the layers that they share |
//! | `maps.rs` | the texture of a view's maps in a frame |
//! | `need.rs` | maps that a view needs |
//!
//! A map is fitted to the visible part of its view's camera. Views share maps only if they are fitted together
//! ([`CameraView::together`](crate::CameraView::together)).

mod atlas;
mod fields;
mod fitted;
mod local;
mod maps;
mod need;
mod settings;
mod splits;
mod sun;
mod view;
mod volume;
mod warp;

#[cfg(test)]
mod tests;

pub use atlas::Place;
pub(crate) use fitted::MapKey;
pub use fitted::ShadowMap;
pub use maps::ShadowMaps;
pub(crate) use need::ShadowNeed;
pub use settings::{
    ContactShadows, Fit, MAX_CASCADES, MAX_MAPS, MomentSettings, ShadowBias, ShadowFilter, ShadowSettings, Splits,
};
pub use view::{ViewShadows, local_layers, local_maps};
pub(crate) use volume::FitCamera;
