//! The phases after pass ordering: from ordered passes to a plan.

use super::liveness::NextUse;
use super::lower::Lowering;
use super::measure::Measures;
use super::merge::{self, Merged};
use super::parts::Parts;
use super::reorder::OrderScratch;
use super::steps::StepView;
use super::validate::Allowed;
use super::{barriers, heap, lifetimes, loads, memoryless, ops_fast_path, place, pool, schedule, stores};
use crate::caps::Caps;
use crate::decision::Decision;
use crate::graph::Tables;
use crate::id::{AccessId, PassId, ResourceId};
use crate::options::{Alias, Options, Order};
use crate::plan::Plan;
use crate::spans::span;

/// Working memory of [`compile`](crate::compile()). Reusing it avoids allocations; it carries no information from one
/// compilation to the next.
#[derive(Debug, Default)]
pub struct Scratch {
    pub(super) measures: Measures,
    pub(super) parts: Parts,
    pub(super) defined: Vec<bool>,
    pub(super) allowed: Allowed,
    pub(super) needs: Vec<NextUse>,
    pub(super) after: Vec<NextUse>,
    pub(super) dropped: Vec<(PassId, AccessId)>,
    pub(super) trimmed: Tables,
    pub(super) order: Vec<PassId>,
    pub(super) merge: merge::MergeScratch,
    pub(super) inlined_into: Vec<AccessId>,
    pub(super) format_of: Vec<ResourceId>,
    pub(super) lowering: Lowering,
    pub(super) writers: Vec<PassId>,
    pub(super) stores: Vec<Decision>,
    pub(super) pool: pool::PoolScratch,
    pub(super) heap: heap::HeapScratch,
    pub(super) barriers: barriers::BarrierScratch,
    pub(super) schedule: schedule::ScheduleScratch,
    pub(super) orders: OrderScratch,
}

impl Scratch {
    /// Creates empty working memory.
    pub fn new() -> Self {
        Self::default()
    }
}

/// Runs every phase after pass ordering on the passes of `scratch.order`.
///
/// With `trial`, skips barriers and returns `false` as soon as the plan has more steps than `trial`. Phases are not
/// inlined into this function, because their values would not fit into the registers.
pub(super) fn plan_order(
    graph: &Tables,
    caps: &Caps,
    options: &Options,
    trial: Option<usize>,
    scratch: &mut Scratch,
    plan: &mut Plan,
) -> bool {
    let frame = options.frame;
    let Plan { pass_steps, steps, step_passes, attachments, resources, slots, memory, barriers, decisions, .. } = plan;
    let Scratch {
        measures,
        parts,
        needs,
        after,
        order,
        merge: merging,
        inlined_into,
        format_of,
        lowering,
        writers,
        stores,
        pool,
        heap,
        ..
    } = scratch;

    let mut merged = Merged { steps, step_passes, inlined_into, format_of, decisions };
    span!("merge" => merge::merge(graph, caps, options, &measures.rows, order, merging, pass_steps, &mut merged));
    if trial.is_some_and(|most| steps.len() > most) {
        return false;
    }
    let lowered = span!("lower" => lowering.lower(graph, caps, steps, step_passes, pass_steps, decisions));
    let (declared, in_store, graph) = (graph.passes.len(), lowered.is_none(), lowered.unwrap_or(graph));
    let view = StepView { graph, step_passes, inlined_into };
    span!("lifetimes" => lifetimes::lifetimes(view, steps, measures, frame, format_of, resources));
    // The liveness found by culling is also valid for steps, unless passes were moved or inlined.
    let as_declared = options.order == Order::Declared && inlined_into.is_empty();
    if as_declared && in_store && !parts.has_several() {
        span!("operations" => ops_fast_path::ops(view, steps, after, stores, attachments, decisions));
    } else {
        span!("loads" => loads::loads(view, parts, steps, writers, attachments, decisions));
        span!("stores" => stores::stores(view, parts, measures, steps, needs, attachments, decisions));
    }
    span!("memoryless" => memoryless::memoryless(graph, caps, options, attachments, resources, decisions));
    place::place(graph, &measures.outside, inlined_into, resources, decisions);
    let placed = options.alias == Alias::Heap && caps.placed;
    let heaps = if placed {
        span!("alias" => heap::heap(graph, caps, options, steps.len(), heap, resources, decisions))
    } else {
        None
    };
    *memory = heaps.unwrap_or_else(|| {
        let (share, measures) = (options.alias != Alias::Off, &measures.rows);
        span!("alias" => pool::pool(graph, measures, steps.len(), share, pool, resources, slots, decisions))
    });

    barriers.clear();
    if caps.explicit_barriers && trial.is_none() {
        let hand = &mut scratch.barriers;
        span!("barriers" => barriers::barriers(view, steps, caps, parts, attachments, resources, hand, barriers));
    }
    if !in_store {
        lowering.rename(declared, step_passes, decisions);
    }
    true
}
