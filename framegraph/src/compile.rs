//! The compiler: derives a plan from a graph. This file lists the phases in order.

mod attachment_set;
mod barriers;
mod bindings;
mod cull;
mod current_step;
mod error;
mod framebuffer;
mod heap;
mod inline;
mod join;
mod layout;
mod lifetimes;
mod liveness;
mod loads;
mod lower;
mod measure;
mod memory;
mod memoryless;
mod merge;
mod ops_fast_path;
mod order;
mod ownership;
mod parts;
mod phases;
mod place;
mod pool;
mod reorder;
mod sampled_alternative;
mod schedule;
mod steps;
mod stores;
mod trim;
mod validate;

pub use error::{CompileError, CompileErrors, CompileReason, ShapeReason};

use crate::caps::Caps;
use crate::error::DeclareError;
use crate::graph::{Graph, Tables};
use crate::id::{PassId, ResourceId};
use crate::options::{Options, Order};
use crate::plan::{Memory, Plan};
use crate::spans::{compiled, span};
use cull::Culled;
pub use phases::Scratch;
use std::sync::atomic::{AtomicU64, Ordering};

/// Compiles `graph` for a device and a frame size into `plan`.
///
/// A pure function of graph, caps and options: equal inputs give byte-identical plans. Previous contents of `scratch`
/// and `plan` have no influence.
///
/// # Errors
/// Returns all errors of the graph at once. `plan` is empty then.
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

/// Compiles like [`compile`], but keeps the heap offsets of an earlier plan.
///
/// Resources keep the offset of the resource with the same name in `earlier`, unless that would make the heap larger.
/// Bind groups of unchanged resources stay valid.
///
/// # Errors
/// Returns the errors of [`compile`].
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
    let span = span!("compile", passes = graph.passes().len(), resources = graph.resources().len(); steps, culled, loads, stores, bytes, barriers);
    plan.begin(graph, caps, options);
    let refused =
        |e: &DeclareError| CompileError::new(graph, CompileReason::Declare(e.clone()), PassId::NONE, ResourceId::NONE);
    let mut errors = CompileErrors::default();
    graph.errors.iter().for_each(|e| errors.push(|| refused(e)));
    let measures = &mut scratch.measures;
    span!("measure" => measure::measure(graph, caps, options.frame, measures, &mut errors));
    // Subresources have no numbers if there are too many of them.
    let too_many = |e: &CompileError| matches!(e.reason, CompileReason::Shape(ShapeReason::TooManySubresources { .. }));
    if errors.more == 0 && !errors.listed.iter().any(too_many) {
        let Scratch { measures, parts, defined, allowed, .. } = scratch;
        parts.number(graph, measures);
        span!("validate" => validate::validate(graph, caps, parts, measures, defined, allowed, &mut errors));
    }
    if let Err(errors) = errors.or(()) {
        // Restores the invariant that an empty plan belongs to an empty graph.
        plan.graph.forget();
        return Err(errors);
    }
    let Scratch { measures, parts, order, after, needs, dropped, trimmed, .. } = scratch;
    let culled = Culled { order, after, needs, dropped };
    span!("cull" => cull::cull(graph, parts, measures, options.cull, culled, &mut plan.decisions));
    if dropped.is_empty() {
        ordered(graph, caps, options, scratch, plan);
    } else {
        let mut trimmed = std::mem::take(trimmed);
        trim::trim(graph, dropped, after, &mut trimmed);
        ordered(&trimmed, caps, options, scratch, plan);
        scratch.trimmed = trimmed;
    }
    plan.number();
    compiled(&span, plan);
    Ok(())
}

/// Runs every phase from pass ordering on.
fn ordered(graph: &Tables, caps: &Caps, options: &Options, scratch: &mut Scratch, plan: &mut Plan) {
    match options.order {
        Order::Declared => {
            phases::plan_order(graph, caps, options, None, scratch, plan);
        }
        Order::Optimized => span!("order" => order::optimized(graph, caps, options, scratch, plan)),
    }
}

/// Compiles like [`compile`], unless `plan` already belongs to an equal graph, the same device and the same options.
/// Returns `true` if it compiled.
///
/// Compares everything that was declared.
///
/// # Errors
/// Returns the errors of [`compile`].
pub fn recompile(
    graph: &Graph,
    caps: &Caps,
    options: &Options,
    scratch: &mut Scratch,
    plan: &mut Plan,
) -> Result<bool, CompileErrors> {
    if plan.compilation != 0 && plan.options == *options && plan.caps == *caps && plan.graph.same_as(graph) {
        plan.graph.share(graph);
        return Ok(false);
    }
    compile(graph, caps, options, scratch, plan).map(|()| true)
}

impl Plan {
    /// Assigns a process-wide unique compilation number.
    pub(crate) fn number(&mut self) {
        static COMPILATIONS: AtomicU64 = AtomicU64::new(1);
        self.compilation = COMPILATIONS.fetch_add(1, Ordering::Relaxed);
    }

    /// Clears the plan and stores its inputs.
    fn begin(&mut self, source: &Graph, for_caps: &Caps, with: &Options) {
        let Self {
            graph,
            caps,
            options,
            compilation,
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
        *compilation = 0;
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
