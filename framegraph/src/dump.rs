//! Plans as text and pictures. Every form is a pure function of the plan and the same to the byte for equal plans.

mod dot;
mod flow;
#[cfg(feature = "petgraph")]
pub mod graph;
mod json;
mod mermaid;
mod reasons;
mod svg;
mod text;
mod words;

pub use dot::dot;
pub use flow::{Flow, data_flow, reduced};
pub use json::{JSON_VERSION, json, totals};
pub(crate) use json::{Json, field, object};
pub use mermaid::mermaid;
pub use svg::svg;
pub use text::{TEXT_VERSION, text};

pub(crate) use words::{bytes, shape};
