//! Light sources: prefiltered environments, the sun, and the settings of shading.
//!
//! | module | content |
//! | --- | --- |
//! | [`ibl`] | image-based light: irradiance harmonics, prefiltered reflections, the DFG table, and their cache |
//! | [`sun`] | the directional light that casts cascaded shadows |
//! | [`shading`] | settings of surface shading |
//!
//! This folder may use [`program`](crate::program) and [`settings`](crate::settings).

pub mod ibl;
pub mod shading;
pub mod sun;
