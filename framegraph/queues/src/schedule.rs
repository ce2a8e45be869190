//! Schedules: plans on several queues.

use crate::assign::assign;
use crate::clocks::{Edge, Order, waits};
use crate::hazards::dependencies;
use crate::layout::{QueueId, QueueLayout};
use crate::simulate::simulate;
use crate::transfers::{Transfer, transfers};
use framegraph::{Plan, ResourceId, StepId};

/// A semaphore: a step waits until a step on another queue has ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wait {
    /// The semaphore is signaled after this step, on its queue.
    pub after: StepId,
    /// The semaphore is waited for before this step, on its queue.
    pub before: StepId,
}

/// The assignment of a plan's steps to queues, and their synchronization.
///
/// Frames follow each other on the first queue. Other queues begin when the previous frame has ended. At the end of the
/// frame, the first queue waits for the last step of each other queue ([`Schedule::joins`]).
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    /// The queues.
    pub layout: QueueLayout,
    /// The queue of each step, in the order of the plan's steps.
    pub lanes: Vec<QueueId>,
    /// The semaphores, in the order of the waiting steps. They do not imply each other.
    pub waits: Vec<Wait>,
    /// The last step of each queue except the first, for which the first waits at the end of the frame.
    pub joins: Vec<StepId>,
    /// Ownership transfers.
    pub transfers: Vec<Transfer>,
    /// Resources that several queues use without an intermediate write, so that none can own them. They must be created
    /// for all queues (`VK_SHARING_MODE_CONCURRENT`).
    pub concurrent: Vec<ResourceId>,
    /// Modeled start and end of each step, in microseconds from the start of the frame.
    pub times_us: Vec<[f64; 2]>,
    /// Modeled duration of the frame on these queues, in microseconds.
    pub total_us: f64,
    /// Duration of the frame on one queue, in microseconds.
    pub alone_us: f64,
    pub(crate) order: Order,
}

impl Schedule {
    /// Returns `true` if queues and semaphores guarantee that `first` ends before `second` begins.
    ///
    /// # Panics
    /// Panics if a step does not belong to the plan.
    #[must_use]
    pub fn is_before(&self, first: StepId, second: StepId) -> bool {
        self.order.is_before(first.index() as u32, second.index() as u32)
    }
}

/// Error of scheduling.
#[derive(Clone, PartialEq, thiserror::Error)]
pub enum QueueError {
    /// The number of costs differs from the number of steps.
    #[error("{given} costs for a plan of {steps} steps; pass one for each step, in order")]
    Costs {
        /// Number of costs.
        given: usize,
        /// Number of steps.
        steps: usize,
    },
    /// A cost is not a valid time.
    #[error("step {step} costs {cost_us} µs; use a finite number of at least 0")]
    Cost {
        /// The step.
        step: usize,
        /// The cost in microseconds.
        cost_us: f64,
    },
    /// The layout lacks a queue that runs everything, or has too many queues.
    #[error("invalid layout; the first queue must run raster, compute and copy steps, with at most 255 queues")]
    Layout,
}

impl std::fmt::Debug for QueueError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        std::fmt::Display::fmt(self, f)
    }
}

/// Schedules `plan` on the queues of `layout`. `costs_us` is the cost of each step in microseconds.
///
/// Steps on one queue stay in the order of the plan. A step leaves the first queue only if that shortens the frame.
///
/// # Errors
/// See [`QueueError`].
pub fn schedule(plan: &Plan, layout: &QueueLayout, costs_us: &[f64]) -> Result<Schedule, QueueError> {
    schedule_with(plan, layout, costs_us, &|_| true)
}

/// Schedules like [`schedule()`], with a restriction on the steps that may leave the first queue.
///
/// `may_leave` is called for steps whose passes do not require the first queue
/// ([`framegraph::PassBuilder::main_queue`]).
///
/// # Errors
/// See [`QueueError`].
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
