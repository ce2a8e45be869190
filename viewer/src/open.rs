//! Opening a file of any kind that the viewer shows: a saved plan, a graph, a trace.

use crate::accuracy_data::AccuracyData;
use crate::file_bytes::bytes_of;
use crate::graph_source::GraphSource;
use crate::job::Handle;
use crate::plan_data::{self, PlanData};
use crate::trace_data::TraceData;
use std::path::Path;
use std::sync::Arc;

/// Plans and traces larger than this are refused, in bytes.
pub const MOST_BYTES: u64 = 512 << 20;

/// What a file turned out to be.
#[derive(Clone, Debug)]
pub enum Opened {
    /// A plan that some program saved.
    Plan(Arc<PlanData>),
    /// A graph, which is planned here.
    Graph(Arc<GraphSource>),
    /// Frames with their times.
    Trace(Arc<TraceData>),
    /// What techniques err by and take.
    Accuracy(Arc<AccuracyData>),
}

/// Opens a file: `.ron` is a graph; JSON is a plan, a trace if it has `traceEvents`, or accuracy
/// by its schema.
///
/// # Errors
/// A line that names the file, the reason, and what to do.
pub fn open(path: &Path, handle: &Handle) -> Result<Opened, String> {
    let shown = path.display();
    if path.extension().is_some_and(|extension| extension == "ron") {
        return GraphSource::open(path).map(|source| Opened::Graph(Arc::new(source)));
    }
    let bytes = bytes_of(path, MOST_BYTES, handle)?;
    let Some(first) = bytes.iter().position(|byte| !byte.is_ascii_whitespace()) else {
        return Err(format!("{shown}: the file is empty"));
    };
    if bytes[first] != b'{' {
        return Err(format!("{shown}: neither a graph (FRAME.ron) nor JSON of a plan or a trace"));
    }
    // The word stands in front of the events, and in no name of a plan's first fields.
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
