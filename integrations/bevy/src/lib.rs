//! Framegraph for Bevy 0.20, in two modes.
//!
//! - **Report**: [`ReportPlugin`] and [`Report`] observe a frame of Bevy's renderer, rebuild it as a graph, and list
//!   unneeded loads and stores, memoryless textures, merges and aliasing.
//! - **Execute**: a chain of passes runs as one compiled graph inside Bevy's render schedule ([`ExecutePlugin`], [`GraphPost`]).

pub mod declare;
pub mod execute;
mod mark;
pub mod observed;
mod record;
pub mod report;
pub mod standard;
mod state;
mod trace;
mod window;

pub use execute::{CameraTextures, Chains, ExecutePlugin, GraphPost};
pub use mark::ReportPlugin;
pub use report::{Report, ReportError};
pub use standard::{PostWorld, StandardPost, standard};
pub use trace::{Device, TraceError};

/// The guide in `docs/guide`, compiled as doc tests.
#[cfg(doctest)]
#[doc = include_str!("../../../docs/guide/bevy.md")]
struct Guide;
