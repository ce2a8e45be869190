//! Shadow maps on the GPU: one texture, with a layer for each cascade of the sun, and layers shared by spot and point
//! lights.
//!
//! | file | content |
//! | --- | --- |
//! | `declare.rs` | passes that a frame's shadow settings need |
//! | `draw.rs` | draws casters into a layer |
//! | `moments.rs` | blurs and halves a layer that holds moments |
//! | `kept.rs` | maps kept from frame to frame |
//! | `input.rs` | bindings of shading passes |
//!
//! Maps are fitted in [`shadow_views`](crate::gpu_scene::shadow_views).

mod declare;
mod draw;
mod input;
mod kept;
mod moments;

pub use declare::{maps_slot, shadow_maps};
#[cfg(feature = "files")]
pub(crate) use draw::maps_desc;
pub use draw::{SHADOW_FORMAT, Shadow, ShadowLayer};
pub(crate) use input::{ShadowBindings, ShadowInput};
pub use kept::{KeptShadows, KeptShadowsError, Redraw};
pub use moments::{MomentStep, ShadowBlur, ShadowLevel};
