//! Punctual lights of a view: the lights that reach visible surfaces, and their lists by froxel.
//!
//! | file | content |
//! | --- | --- |
//! | `settings.rs` | method of finding lights, by name |
//! | `reach.rs` | volume that a light can reach |
//! | `select.rs` | dropped lights, and reasons |
//! | `grid.rs` | froxel grid of a camera |
//! | `assign.rs` | froxels that a volume touches |
//! | `lists.rs` | light lists for shaders, and a report |
//!
//! Everything is computed on the CPU when a view is made. Lists are conservative: no light is missing where it shines.
//! A list may contain lights that only touch the bounds of its froxel, and they contribute nothing there.
//! `docs/design/lights.md` has the cost.

mod assign;
mod grid;
mod lists;
mod reach;
mod select;
mod settings;

pub(crate) use lists::lists;
pub use lists::{Found, LightLists, LightReport, LookedAtAll};
pub use select::DropReason;
pub(crate) use select::select;
pub use settings::{FroxelSettings, LightSearch};

#[cfg(test)]
mod tests;
