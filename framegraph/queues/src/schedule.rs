//! A plan on several queues.

use crate::assign::assign;
use crate::clocks::{Edge, Order, waits};
use crate::hazards::dependencies;
use crate::layout::{QueueId, QueueLayout};
use crate::simulate::simulate;
use crate::transfers::{Transfer, transfers};
use framegraph::{Plan, ResourceId, StepId};

/// A semaphore: a step waits until one on another queue is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wait {
    /// Signalled behind this step, on its queue.
    pub after: StepId,
    /// Waited for in front of this step, on its queue.
    pub before: StepId,
}

/// Which step of a plan runs on which queue, and what is said between them.
///
/// Frames follow each other on the first queue: the others begin when the frame before is over, and at its end the first waits
/// for the last step of each ([`Schedule::joins`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    /// The queues.
    pub layout: QueueLayout,
    /// The queue of each step, in the order of the plan's steps.
    pub lanes: Vec<QueueId>,
    /// The semaphores, in the order of the steps that wait; none of them follows from the others.
    pub waits: Vec<Wait>,
    /// The last step of each queue but the first, which the first waits for at the frame's end.
    pub joins: Vec<StepId>,
    /// What changes its owner.
    pub transfers: Vec<Transfer>,
    /// What several queues touch between two writes, so that no one of them can own it: it is made for all of them
    /// (`VK_SHARING_MODE_CONCURRENT`).
    pub concurrent: Vec<ResourceId>,
    /// When each step begins and ends, in microseconds from the begin of the frame, as the model has it.
    pub times_us: Vec<[f64; 2]>,
    /// The frame on these queues, in microseconds.
    pub total_us: f64,
    /// The frame on one queue, in microseconds.
    pub alone_us: f64,
    pub(crate) order: Order,
}

impl Schedule {
    /// Whether `first` is over before `second` begins, by queues and semaphores.
    ///
    /// # Panics
    /// When a step is not of the plan.
    #[must_use]
    pub fn is_before(&self, first: StepId, second: StepId) -> bool {
        self.order.is_before(first.index() as u32, second.index() as u32)
    }
}

/// Why there is no schedule.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum QueueError {
    /// Costs are not those of the plan's steps.
    #[error("{given} costs were given for a plan of {steps} steps; give one for each, in their order")]
    Costs {
        /// How many there are.
        given: usize,
        /// How many are needed.
        steps: usize,
    },
    /// A cost is no time.
    #[error("step {step} costs {cost_us} µs; a finite number from 0 on is needed")]
    Cost {
        /// The step.
        step: usize,
        /// Its cost.
        cost_us: f64,
    },
    /// The layout has no queue that runs everything.
    #[error("the first of the queues must run raster, compute and copy steps, and there may be 255 at the most")]
    Layout,
}

impl std::fmt::Debug for QueueError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// The schedule of `plan` on the queues of `layout`, by what each step costs in microseconds. The order of steps on one queue is
/// the plan's; a step leaves the first queue only where the frame gets shorter by it.
///
/// # Errors
/// [`QueueError`].
pub fn schedule(plan: &Plan, layout: &QueueLayout, costs_us: &[f64]) -> Result<Schedule, QueueError> {
    schedule_with(plan, layout, costs_us, &|_| true)
}

/// As [`schedule()`]; `may_leave` says which steps may run elsewhere than on the first queue, of those whose passes do not ask to stay
/// there ([`framegraph::PassBuilder::main_queue`]).
///
/// # Errors
/// As [`schedule()`].
pub fn schedule_with(
    plan: &Plan,
    layout: &QueueLayout,
    costs_us: &[f64],
    may_leave: &dyn Fn(StepId) -> bool,
) -> Result<Schedule, QueueError> {
    let (given, steps) = (costs_us.len(), plan.steps().len());
    if given != steps {
        return Err(QueueError::Costs { given, steps });
    }
    if let Some((step, cost_us)) = costs_us.iter().copied().enumerate().find(|(_, cost)| !(0.0..1e15).contains(cost)) {
        return Err(QueueError::Cost { step, cost_us });
    }
    let all = |queue: &crate::Queue| queue.raster && queue.compute && queue.copy;
    if !layout.queues.first().is_some_and(all)
        || layout.queues.len() > 255
        || !(0.0..1e15).contains(&layout.semaphore_us)
    {
        return Err(QueueError::Layout);
    }
    let dependencies = dependencies(plan);
    let lanes = assign(plan, layout, &dependencies, costs_us, may_leave);
    let times = simulate(layout, &lanes, &dependencies, costs_us);
    let wait = |Edge { after, before }| Wait { after: StepId::at(after as usize), before: StepId::at(before as usize) };
    let (edges, order) = waits(layout, &lanes, &dependencies);
    let waits = edges.into_iter().map(wait).collect();
    let last = |queue: QueueId| lanes.iter().rposition(|lane| *lane == queue).map(StepId::at);
    let joins = layout.ids().skip(1).filter_map(last).collect();
    let (transfers, concurrent) = transfers(plan, &lanes);
    let times_us = times.begins_us.iter().zip(&times.ends_us).map(|(begin, end)| [*begin, *end]).collect();
    Ok(Schedule {
        layout: layout.clone(),
        waits,
        joins,
        transfers,
        concurrent,
        times_us,
        total_us: times.total_us,
        alone_us: costs_us.iter().sum(),
        order,
        lanes,
    })
}
