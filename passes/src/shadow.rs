//! Shadow maps: of the sun by cascades, each a layer of one texture, and of spot lights and the faces about point lights, which
//! share layers of it.
//!
//! | file | what |
//! | --- | --- |
//! | `settings.rs` | how shadows are made, in Filament's terms |
//! | `view.rs` | the maps of a view, on the CPU: fitted by `sun.rs` (with `splits.rs`, `volume.rs`, `warp.rs`) and `local.rs` |
//! | `atlas.rs` | where maps lie in the layers that they share |
//! | `draw.rs`, `moments.rs` | passes: casters into a layer; its moments blurred and halved |
//! | `need.rs` | which of them a view has use for |
//! | `declare.rs` | which of these a frame needs |
//! | `kept.rs` | maps that stay from frame to frame |
//! | `input.rs` | the texture as passes that shade take it |
//!
//! A map is fitted to what its view's camera sees, so views share maps only if they are fitted together
//! ([`CameraView::together`](crate::CameraView::together)).

mod atlas;
mod declare;
mod draw;
mod fitted;
mod input;
mod kept;
mod local;
mod moments;
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
pub use declare::{maps_slot, shadow_maps};
#[cfg(feature = "files")]
pub(crate) use draw::maps_desc;
pub use draw::{SHADOW_FORMAT, Shadow, ShadowLayer};
pub use fitted::ShadowMap;
pub(crate) use input::{ShadowBindings, ShadowInput};
pub use kept::{KeptShadows, KeptShadowsError, Redraw};
pub use moments::{MomentStep, ShadowBlur, ShadowLevel};
pub(crate) use need::ShadowNeed;
pub use settings::{
    ContactShadows, Fit, MOST_CASCADES, MOST_MAPS, MomentSettings, ShadowBias, ShadowFilter, ShadowSettings, Splits,
};
pub use view::{ViewShadows, local_layers, local_maps};
pub(crate) use volume::FitCamera;
