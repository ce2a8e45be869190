//! The viewer: a window on plans, graphs and live frames.
//!
//! The views of plans are the panels of [`framegraph_egui`]. This crate adds:
//!
//! - Files: saved plans, traces and measured accuracy ([`mod@open`], [`accuracy_data`]), and sources of plans
//!   ([`what_if::Planner`]): graph files ([`graph_source`]) and the standard frame ([`standard_frame`]).
//! - The application made of panels ([`app`]), optionally with a live frame (`live`, with the feature `window`).

pub mod accuracy_data;
pub mod accuracy_view;
pub mod app;
#[cfg(feature = "window")]
pub mod attached;
mod file_bytes;
pub mod graph_source;
pub mod history;
#[cfg(feature = "window")]
pub mod live;
#[cfg(feature = "window")]
pub mod measuring;
#[cfg(feature = "window")]
pub mod offscreen;
pub mod open;
pub mod remembered;
mod session;
pub mod settings;
pub mod standard_frame;
pub mod watch;

pub use framegraph_egui::{drawing, glossary, job, layout, panel, plan_data, synthetic, trace_data, view, what_if};
