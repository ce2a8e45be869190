//! Plans as text, JSON and graphics. All forms are deterministic: equal plans give byte-identical output.

mod describe;
mod dot;
mod flow;
#[cfg(feature = "petgraph")]
pub mod graph;
mod json;
mod mermaid;
mod reasons;
mod svg;
mod text;

pub use describe::bytes;
pub use dot::dot;
pub use flow::{Flow, data_flow, reduced};
pub use json::{JSON_VERSION, json, totals};
pub(crate) use json::{Json, field, object};
pub use mermaid::mermaid;
pub use svg::{svg, xml_escaped};
pub use text::{TEXT_VERSION, text};

pub(crate) use describe::shape;
