//! Opening of files: saved plans, graphs, traces and accuracy records.

use crate::accuracy_data::AccuracyData;
use crate::file_bytes::bytes_of;
use crate::graph_source::GraphSource;
use crate::job::Handle;
use crate::plan_data::{self, PlanData};
use crate::trace_data::TraceData;
use std::path::Path;
use std::sync::Arc;

/// Maximum size of plans and traces, in bytes.
pub const MAX_BYTES: u64 = 512 << 20;

/// Content of an opened file.
#[derive(Clone, Debug)]
pub enum Opened {
    /// Saved plan.
    Plan(Arc<PlanData>),
    /// Graph, compiled by the viewer.
    Graph(Arc<GraphSource>),
    /// Frame times.
    Trace(Arc<TraceData>),
    /// Errors and costs of settings.
    Accuracy(Arc<AccuracyData>),
}

/// Opens a file. `.ron` is a graph. JSON is a plan, a trace if it has `traceEvents`, or an accuracy record by its schema.
///
/// # Errors
/// One line that names the file, the reason and a remedy.
pub fn open(path: &Path, handle: &Handle) -> Result<Opened, String> {
    let shown = path.display();
    if path.extension().is_some_and(|extension| extension == "ron") {
        return GraphSource::open(path).map(|source| Opened::Graph(Arc::new(source)));
    }
    let bytes = bytes_of(path, MAX_BYTES, handle)?;
    let Some(first) = bytes.iter().position(|byte| !byte.is_ascii_whitespace()) else {
        return Err(format!("{shown}: empty file; open a plan, a graph or a trace"));
    };
    if bytes[first] != b'{' {
        return Err(format!("{shown}: unknown file type; expected a graph (FRAME.ron), or JSON of a plan or a trace"));
    }
    // `traceEvents` precedes the events, and no leading field of a plan has this name.
    let head = &bytes[first..bytes.len().min(first + 256)];
    if String::from_utf8_lossy(head).contains("\"traceEvents\"") {
        return crate::trace_data::read(&bytes)
            .map(|t| Opened::Trace(Arc::new(t)))
            .map_err(|e| format!("{shown}: {e}"));
    }
    if String::from_utf8_lossy(head).contains(crate::accuracy_data::SCHEMA) {
        let mut read = crate::accuracy_data::read(&bytes).map_err(|e| format!("{shown}: {e}"))?;
        read.pictures = path.parent().map(|folder| folder.join("pictures")).filter(|folder| folder.is_dir());
        return Ok(Opened::Accuracy(Arc::new(read)));
    }
    plan_data::read(&bytes).map(|p| Opened::Plan(Arc::new(p))).map_err(|e| format!("{shown}: {e}"))
}
