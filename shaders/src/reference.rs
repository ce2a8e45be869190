//! Functions of `wgsl/lib/` in f64 that programs need on the CPU: tone curves, color grading, tables and the sky.
//!
//! Names of files and functions are those of `wgsl/lib/`. The other functions of the library have mirrors in the package
//! `shaders/mirrors`, which only tests use.

pub mod aces;
pub mod agx;
pub mod cloth;
pub mod dfg;
pub mod dfg_integration;
pub mod display_range;
pub mod gamut;
pub mod ggx;
pub mod grade;
pub mod grading;
pub mod gt7;
pub mod image_light;
pub mod luminance;
pub mod math;
pub mod night;
pub mod primaries;
pub mod rgbm;
pub mod sampling;
pub mod sky;
pub mod srgb;
pub mod table;
pub mod tone_map;
