//! The views: each a pure function from a plan to a [`Drawing`], without a window.

pub mod accuracy;
pub mod bandwidth;
pub mod diff;
pub mod facts;
pub mod graph;
mod heads;
pub mod memory;
pub mod queues;
pub mod timeline;
pub mod trace;
mod words;

pub use words::{bytes, change, change_ink, cost_ink};

use crate::accuracy_data::AccuracyData;
use crate::drawing::{Drawing, Item};
use crate::plan_data::PlanData;
use crate::trace_data::TraceData;

/// The views by name, as the command line and the tabs call them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum View {
    /// Passes and what flows between them.
    Graph,
    /// Resources over passes.
    Timeline,
    /// The heap over time.
    Memory,
    /// Bytes moved by each step.
    Bandwidth,
    /// Everything known about one thing.
    Inspector,
    /// What changed from one plan to another.
    Diff,
    /// The times of many frames.
    Trace,
    /// Error over cost of each technique.
    Accuracy,
    /// The frame on several queues.
    Queues,
}

impl View {
    /// All of them, in the order of the tabs.
    pub const ALL: [Self; 9] = [
        Self::Graph,
        Self::Timeline,
        Self::Memory,
        Self::Bandwidth,
        Self::Inspector,
        Self::Diff,
        Self::Trace,
        Self::Accuracy,
        Self::Queues,
    ];

    /// Whether it shows a plan, and not a file of another kind.
    pub const fn is_of_a_plan(self) -> bool {
        !matches!(self, Self::Trace | Self::Accuracy)
    }

    /// Its name.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Graph => "graph",
            Self::Timeline => "timeline",
            Self::Memory => "memory",
            Self::Bandwidth => "bandwidth",
            Self::Inspector => "inspector",
            Self::Diff => "diff",
            Self::Trace => "trace",
            Self::Accuracy => "accuracy",
            Self::Queues => "queues",
        }
    }
}

/// What a view may look at beside the plan.
#[derive(Clone, Copy, Debug, Default)]
pub struct Beside<'a> {
    /// The plan to compare with.
    pub against: Option<&'a PlanData>,
    /// Times of the frame.
    pub trace: Option<&'a TraceData>,
    /// What techniques err by and take.
    pub accuracy: Option<&'a AccuracyData>,
    /// What a frame that is chosen of them may take, in ms.
    pub budget_ms: f64,
    /// What is selected.
    pub selected: Option<Item>,
}

/// The picture of a view, with the inspector's lines of at most so many letters.
pub fn drawing(view: View, plan: &PlanData, beside: Beside<'_>, letters: usize) -> Drawing {
    match view {
        View::Graph => graph::drawing(plan, beside.against),
        View::Timeline => timeline::drawing(plan, beside.trace),
        View::Memory => memory::drawing(plan, beside.against),
        View::Bandwidth => bandwidth::drawing(plan, beside.against),
        View::Inspector => facts::drawing(&facts::sections(plan, beside.selected), letters),
        View::Diff => diff::drawing(beside.against, plan),
        View::Trace => trace::drawing(beside.trace),
        View::Accuracy => accuracy::drawing(beside.accuracy, beside.budget_ms),
        View::Queues => queues::drawing(plan, beside.trace),
    }
}
