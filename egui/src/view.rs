//! Views: pure functions from a plan to a [`Drawing`], independent of windows.

pub mod bandwidth;
pub mod diff;
mod format;
pub mod graph;
mod heads;
pub mod inspector;
pub mod memory;
pub mod queues;
pub mod table;
pub mod timeline;
pub mod trace;

pub use format::{bytes, change, change_ink, cost_ink, label};

use crate::drawing::{Drawing, Item};
use crate::plan_data::PlanData;
use crate::trace_data::TraceData;

/// Views with the names used by the command line and the tabs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
pub enum View {
    /// Passes and their dependencies.
    Graph,
    /// Lifetimes of resources over passes.
    Timeline,
    /// Heap over time.
    Memory,
    /// Bytes moved by each step.
    Bandwidth,
    /// All data of the selected item.
    Inspector,
    /// Differences between two plans.
    Diff,
    /// Times of many frames.
    Trace,
    /// Schedule on several queues.
    Queues,
}

impl View {
    /// All views, in the order of the tabs.
    pub const ALL: [Self; 8] = [
        Self::Graph,
        Self::Timeline,
        Self::Memory,
        Self::Bandwidth,
        Self::Inspector,
        Self::Diff,
        Self::Trace,
        Self::Queues,
    ];

    /// Returns whether the view shows a plan rather than another kind of file.
    pub const fn is_of_a_plan(self) -> bool {
        !matches!(self, Self::Trace)
    }

    /// Returns the name.
    pub const fn word(self) -> &'static str {
        match self {
            Self::Graph => "graph",
            Self::Timeline => "timeline",
            Self::Memory => "memory",
            Self::Bandwidth => "bandwidth",
            Self::Inspector => "inspector",
            Self::Diff => "diff",
            Self::Trace => "trace",
            Self::Queues => "queues",
        }
    }
}

/// Data that views show in addition to the plan.
#[derive(Clone, Copy, Debug, Default)]
pub struct ViewContext<'a> {
    /// Plan to compare with.
    pub against: Option<&'a PlanData>,
    /// Frame times.
    pub trace: Option<&'a TraceData>,
    /// Selected item.
    pub selected: Option<Item>,
}

/// Returns the drawing of a view; `letters` is the number of characters per line of the inspector.
pub fn drawing(view: View, plan: &PlanData, context: ViewContext<'_>, letters: usize) -> Drawing {
    match view {
        View::Graph => graph::drawing(plan, context.against),
        View::Timeline => timeline::drawing(plan, context.trace),
        View::Memory => memory::drawing(plan, context.against),
        View::Bandwidth => bandwidth::drawing(plan, context.against),
        View::Inspector => inspector::drawing(&inspector::sections(plan, context.selected), letters),
        View::Diff => diff::drawing(context.against, plan),
        View::Trace => trace::drawing(context.trace, plan),
        View::Queues => queues::drawing(plan, context.trace),
    }
}
