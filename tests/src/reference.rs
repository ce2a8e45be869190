//! Reference pictures: scenes described in JSON with another renderer's pictures, rendered again and compared.
//!
//! ```text
//! JSON ─ document ─> Document ─ built ─> what is not built
//!           └─ render (asset, studio) ─> Picture ─┐
//! EXR, PNG, CSV ─ picture, chart ─> Picture, Patches ─┴─ metrics (flip), rule ─> Outcome
//! ```
//!
//! The code that compares pictures is independent of the renderer.

pub mod asset;
pub mod bloom;
pub mod built;
pub mod chart;
pub mod color;
pub mod document;
pub mod examine;
pub mod fog;
pub mod light;
pub mod metrics;
pub mod occlusion;
pub mod picture;
pub mod report;
pub mod rule;
pub mod studio;
mod temporal;
