//! Panels for egui that show the plans of [`framegraph`]: passes, decisions with their reasons, memory and times.
//!
//! [`PlanPanels`] is everything in one widget. The other modules are its parts, and each is useful alone:
//!
//! - Data: plans as rows ([`plan_data`]), frame times ([`trace_data`]), and what-if questions ([`what_if`]).
//! - Drawings as data ([`drawing`]), created by pure functions ([`view`]).
//! - Panels that paint drawings and tables ([`panel`]).
//!
//! Without features, egui is the only UI dependency. There is no window library and no graphics API. The feature `overlay` draws
//! egui over a frame in a window of winit (`overlay::Overlay`), and the feature `wgpu` reads the frame times of `framegraph-wgpu`
//! (`trace_data::TraceData::of_trace`).
#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod drawing;
pub mod editor;
pub mod glossary;
pub mod job;
pub mod layout;
#[cfg(feature = "overlay")]
pub mod overlay;
pub mod panel;
pub mod plan_data;
mod plan_panels;
pub mod synthetic;
pub mod trace_data;
pub mod view;
pub mod what_if;

pub use plan_panels::{PlanPanels, Preview};
