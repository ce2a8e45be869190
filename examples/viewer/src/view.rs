//! The views: each a pure function from a plan to a [`Drawing`](crate::drawing::Drawing), without a window.

pub mod bandwidth;
pub mod diff;
pub mod facts;
pub mod graph;
mod heads;
pub mod memory;
pub mod timeline;
pub mod trace;

use crate::drawing::{Drawing, Ink, Item};
use crate::plan_data::PlanData;
use crate::trace_data::TraceData;

/// Bytes with a unit that keeps three or four digits.
pub fn bytes(count: u64) -> String {
    const UNITS: [&str; 5] = ["B", "KiB", "MiB", "GiB", "TiB"];
    let mut value = count as f64;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < UNITS.len() {
        value /= 1024.0;
        unit += 1;
    }
    if unit == 0 { format!("{count} B") } else { format!("{value:.1} {}", UNITS[unit]) }
}

/// How a figure changed: `+3`, `-1.5 MiB`, `=` where it did not.
pub fn change(before: u64, after: u64, is_bytes: bool) -> String {
    let amount = before.abs_diff(after);
    let amount = if is_bytes { bytes(amount) } else { amount.to_string() };
    match before.cmp(&after) {
        std::cmp::Ordering::Less => format!("+{amount}"),
        std::cmp::Ordering::Greater => format!("-{amount}"),
        std::cmp::Ordering::Equal => "=".into(),
    }
}

/// The color of a change in a cost: more is worse.
pub fn change_ink(before: u64, after: u64) -> Ink {
    match before.cmp(&after) {
        std::cmp::Ordering::Less => Ink::Worse,
        std::cmp::Ordering::Greater => Ink::Better,
        std::cmp::Ordering::Equal => Ink::Faint,
    }
}

/// The same for a figure of the totals; those that are no cost stay plain.
pub fn cost_ink(name: &str, before: u64, after: u64) -> Ink {
    let costs = matches!(name, "unresolves" | "resolves" | "steps" | "render_passes") || name.ends_with("_bytes");
    if costs && name != "avoided_bytes" { change_ink(before, after) } else { Ink::Text }
}

/// The heading of a picture: what frame, for what, how large.
fn title(drawing: &mut Drawing, what: &str, plan: &PlanData) -> f32 {
    let form = &plan.form;
    let name = if form.name.is_empty() { "the frame" } else { &form.name };
    let [w, h] = form.frame;
    let head = format!("{what}: {name}, for {} at {w}x{h}", form.caps);
    drawing.text([0.0, 10.0], 16.0, Ink::Text, head);
    let mut y = 10.0;
    for warning in &form.warnings {
        y += 20.0;
        drawing.text([0.0, y], 12.0, Ink::Worse, format!("warning: {}", warning.sentence));
    }
    y + 24.0
}

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
}

impl View {
    /// All of them, in the order of the tabs.
    pub const ALL: [Self; 7] =
        [Self::Graph, Self::Timeline, Self::Memory, Self::Bandwidth, Self::Inspector, Self::Diff, Self::Trace];

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
    /// What is selected.
    pub selected: Option<Item>,
}

/// The picture of a view, with the inspector's lines of at most so many letters.
pub fn drawing(view: View, plan: &PlanData, beside: Beside<'_>, letters: usize) -> Drawing {
    match view {
        View::Graph => graph::drawing(plan),
        View::Timeline => timeline::drawing(plan, beside.trace),
        View::Memory => memory::drawing(plan, beside.against),
        View::Bandwidth => bandwidth::drawing(plan, beside.against),
        View::Inspector => facts::drawing(&facts::sections(plan, beside.selected), letters),
        View::Diff => diff::drawing(beside.against, plan),
        View::Trace => trace::drawing(beside.trace),
    }
}
