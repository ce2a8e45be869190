//! Panels for egui that show the plans of [`framegraph`]: passes, decisions with their reasons, memory and times.
//!
//! [`PlanPanels`] is everything in one widget. The other modules are its parts, and each is useful alone:
//!
//! - Data: plans as rows ([`plan_data`]), frame times ([`trace_data`]), and what-if questions ([`what_if`]).
//! - Drawings as data ([`drawing`]), created by pure functions ([`view`]).
//! - Panels that paint drawings and tables ([`panel`]).
//!
//! The crate depends on egui alone, and on no window library or graphics API.
#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod drawing;
pub mod editor;
pub mod glossary;
pub mod job;
pub mod layout;
pub mod panel;
pub mod plan_data;
pub mod synthetic;
pub mod trace_data;
pub mod view;
pub mod what_if;
