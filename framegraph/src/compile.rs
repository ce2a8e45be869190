//! Compiling: from what was declared to what is executed, the phases in order on one screen.

mod barriers;
mod classes;
mod cull;
mod error;
mod group;
mod heap;
mod inline;
mod join;
mod layout;
mod lifetimes;
mod loads;
mod measure;
mod memory;
mod memoryless;
mod merge;
mod need;
mod order;
mod ownership;
mod parts;
mod place;
mod pool;
mod reorder;
mod schedule;
mod shape;
mod steps;
mod stores;
mod validate;
mod wholes;

pub use error::{CompileError, CompileErrors, CompileReason};

use crate::caps::Caps;
use crate::decision::Decision;
use crate::graph::{Graph, Tables};
use crate::id::{AccessId, PassId, ResourceId};
use crate::options::{Alias, Options, Order};
use crate::plan::{Memory, Plan};
use cull::Culled;
use measure::Measures;
use merge::Merged;
use need::Need;
use parts::Parts;
use steps::StepView;

/// Working memory of [`compile`], kept between compiles so that none of them allocates once it is warm. Carries no
/// information from one compile to the next.
#[derive(Debug, Default)]
pub struct Scratch {
    measures: Measures,
    parts: Parts,
    defined: Vec<bool>,
    needs: Vec<Need>,
    after: Vec<Need>,
    order: Vec<PassId>,
    merge: merge::MergeScratch,
    inlined_into: Vec<AccessId>,
    format_of: Vec<ResourceId>,
    writers: Vec<PassId>,
    stores: Vec<Decision>,
    pool: pool::PoolScratch,
    heap: heap::HeapScratch,
    barriers: barriers::BarrierScratch,
    schedule: schedule::ScheduleScratch,
    orders: order::OrderScratch,
}

impl Scratch {
    /// Empty working memory.
    pub fn new() -> Self {
        Self::default()
    }
}

/// Compiles `graph` for a device and a frame into `plan`.
///
/// A pure function of graph, caps and options: equal inputs give equal plans, byte for byte, whatever `scratch` and `plan`
/// held before.
///
/// # Errors
/// Everything that is wrong with the graph, all at once. `plan` is empty then.
pub fn compile(
    graph: &Graph,
    caps: &Caps,
    options: &Options,
    scratch: &mut Scratch,
    plan: &mut Plan,
) -> Result<(), CompileErrors> {
    scratch.heap.previous.clear();
    compile_keeping(graph, caps, options, scratch, plan)
}

/// As [`compile`], and resources keep the heap offsets that those of the same name have in `earlier`, wherever that does not
/// raise the heap's size: bind groups of an unchanged frame stay valid when a neighbour changes.
///
/// # Errors
/// As [`compile`].
pub fn compile_after(
    graph: &Graph,
    caps: &Caps,
    options: &Options,
    earlier: &Plan,
    scratch: &mut Scratch,
    plan: &mut Plan,
) -> Result<(), CompileErrors> {
    heap::remember(graph, earlier, &mut scratch.heap.previous);
    compile_keeping(graph, caps, options, scratch, plan)
}

fn compile_keeping(
    graph: &Graph,
    caps: &Caps,
    options: &Options,
    scratch: &mut Scratch,
    plan: &mut Plan,
) -> Result<(), CompileErrors> {
    plan.begin(graph, caps, options);
    let mut errors: Vec<_> = graph.errors.iter().map(refused).collect();
    let measures = &mut scratch.measures;
    measure::measure(graph, caps, options.frame, measures, &mut errors);
    if errors.is_empty() {
        let Scratch { measures, parts, defined, .. } = scratch;
        parts.number(&graph.resources, measures);
        validate::validate(graph, caps, parts, measures, defined, &mut errors);
    }
    if !errors.is_empty() {
        // An empty plan is of an empty graph: whoever reads it finds arrays that fit each other.
        plan.graph.forget();
        return Err(CompileErrors(errors));
    }
    let Scratch { measures, parts, order, after, needs, .. } = scratch;
    let culled = Culled { order, after, needs };
    cull::cull(graph, parts, measures, options.cull, culled, &mut plan.decisions);
    match options.order {
        Order::Declared => {
            realise(graph, caps, options, None, scratch, plan);
        }
        Order::Optimized => order::optimized(graph, caps, options, scratch, plan),
    }
    plan.valid = true;
    Ok(())
}

/// Plans the passes of `scratch.order` to the end: every phase after the order. A `trial` leaves barriers out, and ends with
/// false as soon as it has more steps than that. Phases are functions to the machine too (`inline(never)`): in a single one
/// their values would not fit the registers.
fn realise(
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
        writers,
        stores,
        pool,
        heap,
        ..
    } = scratch;

    let mut merged = Merged { steps, step_passes, inlined_into, format_of, decisions };
    merge::merge(graph, caps, options, &measures.rows, order, merging, pass_steps, &mut merged);
    if trial.is_some_and(|most| steps.len() > most) {
        return false;
    }
    let view = StepView { graph, step_passes, inlined_into };
    lifetimes::lifetimes(view, steps, measures, frame, format_of, resources);
    // What culling found on its way back holds for the steps too, unless something moved.
    let as_declared = options.order == Order::Declared && inlined_into.is_empty();
    if as_declared && !parts.has_several() {
        wholes::ops_of_wholes(view, steps, after, stores, attachments, decisions);
    } else {
        loads::loads(view, parts, steps, writers, attachments, decisions);
        stores::stores(view, parts, measures, steps, needs, attachments, decisions);
    }
    memoryless::memoryless(graph, caps, options, attachments, resources, decisions);
    place::place(graph, inlined_into, resources, decisions);
    let placed = options.alias == Alias::Heap && caps.placed;
    let heaps = if placed { heap::heap(graph, caps, options, steps.len(), heap, resources, decisions) } else { None };
    *memory = heaps.unwrap_or_else(|| {
        let (share, measures) = (options.alias != Alias::Off, &measures.rows);
        pool::pool(graph, measures, steps.len(), share, pool, resources, slots, decisions)
    });

    barriers.clear();
    if caps.explicit_barriers && trial.is_none() {
        let hand = &mut scratch.barriers;
        barriers::barriers(view, steps, caps, parts, resources, hand, barriers);
    }
    true
}

/// As [`compile`], unless `plan` was compiled from an equal graph for the same device and options: then nothing is done.
/// Everything that was declared is compared, so nothing can be forgotten. Returns whether it compiled.
///
/// # Errors
/// As [`compile`].
pub fn recompile(
    graph: &Graph,
    caps: &Caps,
    options: &Options,
    scratch: &mut Scratch,
    plan: &mut Plan,
) -> Result<bool, CompileErrors> {
    if plan.valid && plan.options == *options && plan.caps == *caps && plan.graph.same_as(graph) {
        plan.graph.share(graph);
        return Ok(false);
    }
    compile(graph, caps, options, scratch, plan).map(|()| true)
}

fn refused(error: &crate::error::DeclareError) -> CompileError {
    CompileError {
        reason: CompileReason::Declare(error.clone()),
        pass: String::new(),
        resource: String::new(),
        location: None,
    }
}

impl Plan {
    /// Empties the plan and notes what it will be made from.
    fn begin(&mut self, source: &Graph, for_caps: &Caps, with: &Options) {
        let Self {
            graph,
            caps,
            options,
            valid,
            pass_steps,
            steps,
            step_passes,
            attachments,
            resources,
            slots,
            memory,
            barriers,
            decisions,
        } = self;
        graph.share(source);
        caps.copy_from(for_caps);
        *options = *with;
        *valid = false;
        pass_steps.clear();
        steps.clear();
        step_passes.clear();
        attachments.clear();
        resources.clear();
        slots.clear();
        *memory = Memory::default();
        barriers.clear();
        decisions.clear();
    }
}
