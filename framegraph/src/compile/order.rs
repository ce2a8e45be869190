//! Phase 3: order of the kept passes.
//!
//! The default is declaration order. The optimizing order is found by search: declaration order, three list schedules
//! (see `schedule`) and moves of passes (see `reorder`) are planned completely, and the cheapest plan is kept. The cost
//! is the number of steps, then memory, then traffic between tile and memory. Declaration order is tried first and wins
//! ties, so the result is never worse.

use super::phases::{Scratch, plan_order};
use super::reorder::OrderScratch;
use super::schedule::{self, Aim};
use crate::caps::Caps;
use crate::decision::{Decision, Reason, Subject};
use crate::graph::Tables;
use crate::id::PassId;
use crate::options::{Effort, Options};
use crate::plan::Plan;

/// Budget of all moves, in examined positions of orders. Bounds the time for any graph.
const LOOKS: usize = 1 << 20;

/// Cost of planning one pass, in examined positions.
const LOOKS_PER_PASS: usize = 32;

/// Steps, bytes of memory, bytes between tile and memory; compared in this order.
type Cost = (usize, u64, u64);

/// Higher than any real cost.
const WORST: Cost = (usize::MAX, u64::MAX, u64::MAX);

/// Plans the passes of `scratch.order` in the best order found.
pub(crate) fn optimized(graph: &Tables, caps: &Caps, options: &Options, scratch: &mut Scratch, plan: &mut Plan) {
    let mut orders = std::mem::take(&mut scratch.orders);
    let OrderScratch { declared, best, trial, moves, log } = &mut orders;
    declared.clone_from(&scratch.order);
    schedule::dependencies(graph, &scratch.parts, declared, &mut scratch.schedule);
    let start = plan.decisions.len();
    let mut attempt = |order: &[u32], options: &Options, trial: Option<usize>, scratch: &mut Scratch| -> Option<Cost> {
        plan.decisions.truncate(start);
        scratch.order.clear();
        scratch.order.extend(order.iter().map(|index| declared[*index as usize]));
        let done = plan_order(graph, caps, options, trial, scratch, plan);
        done.then(|| (plan.steps.len(), plan.memory.bytes, plan.traffic(options.frame).total_bytes()))
    };
    // Expensive heap packing is reserved for the final plan.
    let quick = Options { effort: Effort::Greedy, ..*options };
    best.clear();
    best.extend(0..declared.len() as u32);
    let mut least = attempt(best, &quick, Some(usize::MAX), scratch).unwrap_or(WORST);
    let mut try_out = |trial: &mut Vec<u32>, best: &mut Vec<u32>, scratch: &mut Scratch| {
        let cost = attempt(trial, &quick, Some(least.0), scratch).unwrap_or(WORST);
        let better = cost < least;
        if better {
            least = cost;
            std::mem::swap(best, trial);
        }
        better
    };
    for aim in Aim::ALL {
        schedule::schedule(graph, options.frame, declared, aim, &mut scratch.schedule, trial);
        try_out(trial, best, scratch);
    }
    let mut looks = LOOKS;
    moves.start(declared.len());
    while moves.next(graph, declared, &scratch.schedule, best, &mut looks, trial) {
        if try_out(trial, best, scratch) {
            moves.helped();
        }
        looks = looks.saturating_sub(declared.len() * LOOKS_PER_PASS);
    }
    trial.clear();
    trial.extend(0..declared.len() as u32);
    let unmoved = attempt(trial, options, None, scratch);
    if best != trial && attempt(best, options, None, scratch) >= unmoved {
        attempt(trial, options, None, scratch);
    }
    explain(plan, &scratch.order, log);
    plan.decisions.splice(start..start, log.drain(..));
    scratch.orders = orders;
}

/// Logs the reason for each pass that follows a different pass than in declaration order.
fn explain(plan: &Plan, order: &[PassId], log: &mut Vec<Decision>) {
    log.clear();
    let declared = |pass: PassId| (0..pass.index()).rev().map(PassId::at).find(|p| !plan.is_culled(*p));
    for pair in order.windows(2) {
        let &[before, pass] = pair else { continue };
        if declared(pass) != Some(before) {
            let shares = plan.pass_steps[pass.index()] == plan.pass_steps[before.index()];
            let reason = if shares { Reason::OrderMerge(before) } else { Reason::OrderBytes(before) };
            log.push(Decision { subject: Subject::Pass(pass), reason });
        }
    }
}
