//! Punctual lights of a view: which of them reach what it shows, and which reach what part of it.
//!
//! | file | what |
//! | --- | --- |
//! | `settings.rs` | how lights are found, by name |
//! | `reach.rs` | the volume that a light can light |
//! | `select.rs` | which lights are dropped, and why |
//! | `grid.rs` | what a camera sees, cut into froxels |
//! | `assign.rs` | which froxels a volume touches |
//! | `lists.rs` | the lists of lights that shaders read, and what became of the lights |
//!
//! All of it is arithmetic on the CPU, done when a view is made. A light that reaches a place is never missed; a list may
//! hold lights that do not quite reach into its froxel, and they add nothing there. `docs/design/lights.md` has what it takes.

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
