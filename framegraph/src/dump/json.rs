//! The plan as JSON, for tools outside of this crate. `docs/plan-json.md` documents the fields, `docs/plan.schema.json`
//! is their schema (JSON Schema, draft 2020-12); a test holds them against what is written.
//!
//! The structs are a view with names in the place of ids: the plan's own arrays are free to change, these are not, short
//! of a new [`JSON_VERSION`].

mod barriers;
mod decisions;
mod resources;
mod steps;

pub use barriers::BarrierView;
pub use decisions::DecisionView;
pub use resources::{ResourceView, SlotView};
pub use steps::{AccessView, AttachmentView, PassView, StepView};

use super::reasons::Reasons;
use crate::options::{Alias, Order};
use crate::plan::Plan;

/// The version of the format; it counts up whenever a field changes its meaning or goes.
pub const JSON_VERSION: u32 = 1;

/// A plan.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct View {
    /// Always `framegraph-plan`.
    pub schema: &'static str,
    /// [`JSON_VERSION`].
    pub version: u32,
    /// What the frame is called; may be empty.
    pub name: String,
    /// The device that the plan is for.
    pub caps: String,
    /// Width and height of the frame, in texels.
    pub frame: [u32; 2],
    /// `declared` or `optimized`.
    pub order: &'static str,
    /// `off`, `pool` or `heap`: what was asked for.
    pub alias: &'static str,
    /// Sums over the plan.
    pub totals: Totals,
    /// When the most bytes are live.
    pub peak: Option<Peak>,
    /// Declared passes, in declaration order.
    pub passes: Vec<PassView>,
    /// Steps, in execution order.
    pub steps: Vec<StepView>,
    /// Declared resources, in declaration order.
    pub resources: Vec<ResourceView>,
    /// Physical textures and buffers of the pool; empty when resources have places in a heap.
    pub slots: Vec<SlotView>,
    /// Transitions and hand-overs; empty for devices that do without.
    pub barriers: Vec<BarrierView>,
    /// Every decision, in the order in which it was taken.
    pub decisions: Vec<DecisionView>,
}

/// Counts and bytes of a whole plan.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
#[allow(missing_docs, reason = "each is the field of the same name of Counts, Traffic or Memory")]
pub struct Totals {
    pub unresolves: u32,
    pub resolves: u32,
    pub unresolve_bytes: u64,
    pub resolve_bytes: u64,
    pub multisample_resolves: u32,
    pub multisample_resolve_bytes: u64,
    pub clears: u32,
    pub discards: u32,
    pub memoryless: u32,
    pub inlined: u32,
    pub steps: u32,
    pub render_passes: u32,
    pub passes: u32,
    pub culled: u32,
    pub heap_bytes: u64,
    pub lower_bound_bytes: u64,
    pub gap_bytes: u64,
    pub optimal: bool,
    pub unaliased_bytes: u64,
    pub avoided_bytes: u64,
    pub own_bytes: u64,
}

impl Totals {
    /// Names and values, in the order of the fields; a truth value as 0 or 1.
    pub fn rows(&self) -> [(&'static str, u64); 21] {
        let t = *self;
        [
            ("unresolves", t.unresolves.into()),
            ("resolves", t.resolves.into()),
            ("unresolve_bytes", t.unresolve_bytes),
            ("resolve_bytes", t.resolve_bytes),
            ("multisample_resolves", t.multisample_resolves.into()),
            ("multisample_resolve_bytes", t.multisample_resolve_bytes),
            ("clears", t.clears.into()),
            ("discards", t.discards.into()),
            ("memoryless", t.memoryless.into()),
            ("inlined", t.inlined.into()),
            ("steps", t.steps.into()),
            ("render_passes", t.render_passes.into()),
            ("passes", t.passes.into()),
            ("culled", t.culled.into()),
            ("heap_bytes", t.heap_bytes),
            ("lower_bound_bytes", t.lower_bound_bytes),
            ("gap_bytes", t.gap_bytes),
            ("optimal", t.optimal.into()),
            ("unaliased_bytes", t.unaliased_bytes),
            ("avoided_bytes", t.avoided_bytes),
            ("own_bytes", t.own_bytes),
        ]
    }
}

/// The step at which the most bytes are live.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "files", derive(serde::Serialize))]
pub struct Peak {
    /// Its index.
    pub step: usize,
    /// Its passes.
    pub passes: Vec<String>,
    /// The resources that are live then and take memory of the heap or pool.
    pub resources: Vec<String>,
}

/// The plan as JSON text, indented, ending in a line feed; `name` is what the frame is called.
#[cfg(feature = "files")]
pub fn json(plan: &Plan, name: &str) -> String {
    // Structs of strings, numbers and arrays cannot fail to be written.
    let mut text = serde_json::to_string_pretty(&View::new(plan, name)).unwrap_or_default();
    text.push('\n');
    text
}

impl View {
    /// The view of a plan; `name` is what the frame is called.
    pub fn new(plan: &Plan, name: &str) -> Self {
        let graph = plan.graph();
        let reasons = Reasons::new(plan);
        Self {
            schema: "framegraph-plan",
            version: JSON_VERSION,
            name: name.into(),
            caps: plan.caps().name.clone(),
            frame: plan.frame(),
            order: match plan.options().order {
                Order::Declared => "declared",
                Order::Optimized => "optimized",
            },
            alias: match plan.options().alias {
                Alias::Off => "off",
                Alias::Pool => "pool",
                Alias::Heap => "heap",
            },
            totals: totals(plan),
            peak: peak(plan),
            passes: graph.pass_ids().map(|p| PassView::new(plan, &reasons, p)).collect(),
            steps: plan.step_ids().map(|s| StepView::new(plan, &reasons, s)).collect(),
            resources: resources::views(plan),
            slots: resources::slots(plan),
            barriers: plan.barriers().iter().map(|b| BarrierView::new(plan, b)).collect(),
            decisions: plan.decisions().iter().map(|d| DecisionView::new(plan, *d)).collect(),
        }
    }
}

fn totals(plan: &Plan) -> Totals {
    let counts = plan.counts();
    let traffic = plan.traffic(plan.frame());
    let memory = plan.memory();
    Totals {
        unresolves: counts.unresolves,
        resolves: counts.resolves,
        unresolve_bytes: traffic.loaded_bytes,
        resolve_bytes: traffic.stored_bytes,
        multisample_resolves: counts.multisample_resolves,
        multisample_resolve_bytes: traffic.resolved_bytes,
        clears: counts.clears,
        discards: counts.discards,
        memoryless: counts.memoryless,
        inlined: counts.inlined,
        steps: counts.steps,
        render_passes: counts.render_passes,
        passes: counts.passes,
        culled: counts.culled,
        heap_bytes: memory.bytes,
        lower_bound_bytes: memory.lower_bound_bytes,
        gap_bytes: memory.bytes.saturating_sub(memory.lower_bound_bytes),
        optimal: memory.optimal,
        unaliased_bytes: memory.unaliased_bytes,
        avoided_bytes: memory.avoided_bytes,
        own_bytes: memory.own_bytes,
    }
}

fn peak(plan: &Plan) -> Option<Peak> {
    let step = plan.memory().peak.some()?;
    let graph = plan.graph();
    let passes = plan.passes_of(step).iter().map(|m| graph.pass_name(m.pass).to_owned());
    let live = graph
        .resource_ids()
        .filter(|r| super::held(plan, *r).is_some_and(|(first, last)| first <= step && step <= last));
    Some(Peak {
        step: step.index(),
        passes: passes.collect(),
        resources: live.map(|r| graph.resource_name(r).to_owned()).collect(),
    })
}
