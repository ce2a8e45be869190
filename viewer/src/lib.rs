//! What a frame does, why, and what it costs: panels for an egui application, and all that they show as data.
//!
//! Three layers, each of use without the next:
//!
//! - data: a plan as rows ([`plan_data`]), live or saved; a trace ([`trace_data`]); accuracy
//!   ([`accuracy_data`]); whoever can plan the frame anew
//!   ([`what_if::Planner`], of which [`graph_source`] is the one for graph files and
//!   [`standard_frame`] the one for the standard frame);
//! - pictures as data ([`drawing`]), made by pure functions ([`view`]);
//! - panels that paint them ([`panel`]), and the application made of panels ([`app`]), which may draw a frame of its own
//!   (`live`, with the feature `window`).

pub mod accuracy_data;
pub mod app;
pub mod drawing;
mod file_bytes;
pub mod glossary;
pub mod graph_source;
pub mod history;
pub mod job;
pub mod layout;
#[cfg(feature = "window")]
pub mod live;
#[cfg(feature = "window")]
pub mod measuring;
#[cfg(feature = "window")]
pub mod offscreen;
pub mod open;
pub mod panel;
pub mod plan_data;
mod session;
pub mod settings;
pub mod standard_frame;
pub mod trace_data;
pub mod view;
pub mod watch;
pub mod what_if;
