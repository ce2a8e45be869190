//! Panels for egui applications that show a frame's passes, decisions and costs.
//!
//! The crate has three layers. Each is useful without the next.
//!
//! - Data: a live or saved plan as rows ([`plan_data`]), frame times ([`trace_data`]), measured accuracy
//!   ([`accuracy_data`]), and sources of plans ([`what_if::Planner`]): graph files ([`graph_source`]) and the standard frame
//!   ([`standard_frame`]).
//! - Drawings as data ([`drawing`]), created by pure functions ([`view`]).
//! - Panels that paint drawings ([`panel`]), and the application made of panels ([`app`]), optionally with a live frame
//!   (`live`, with the feature `window`).

pub mod accuracy_data;
pub mod app;
#[cfg(feature = "window")]
pub mod attached;
pub mod drawing;
pub mod editor;
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
pub mod remembered;
mod session;
pub mod settings;
pub mod standard_frame;
pub mod trace_data;
pub mod view;
pub mod watch;
pub mod what_if;
