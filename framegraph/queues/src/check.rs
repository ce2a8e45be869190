//! An independent checker of schedules: it shares no code with the scheduler and checks the order of steps pair by
//! pair.

use crate::layout::QueueId;
use crate::memory::SharedMemory;
use crate::schedule::Schedule;
use framegraph::{Access, PassFlags, Placement, Plan, ResourceId, StepId, StepPass};
use std::fmt;

/// An error in a schedule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Violation {
    /// The schedule belongs to another plan: the number of steps differs, or a queue does not exist.
    OtherPlan,
    /// The queue cannot run the step, or a pass of the step requires the first queue.
    WrongQueue {
        /// The step.
        step: StepId,
    },
    /// Two steps use the same contents, one of them writes or changes the layout, and they are not ordered.
    Unordered {
        /// The step that is earlier in the plan.
        first: StepId,
        /// The later step.
        second: StepId,
        /// The resource.
        resource: ResourceId,
    },
    /// A step reuses the memory of another resource without waiting for a step that uses it.
    Memory {
        /// The step that uses the previous resource.
        first: StepId,
        /// The step that reuses the memory.
        second: StepId,
        /// The new resource.
        resource: ResourceId,
    },
    /// A step needs contents that another queue owns.
    NotOwned {
        /// The step.
        step: StepId,
        /// The resource.
        resource: ResourceId,
    },
    /// The end of the frame does not wait for a queue.
    NotJoined {
        /// The queue.
        queue: QueueId,
    },
}

impl fmt::Display for Violation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherPlan => write!(f, "the schedule belongs to another plan"),
            Self::WrongQueue { step } => write!(f, "step {} is on a queue that cannot run it", step.index()),
            Self::Unordered { first, second, resource } => {
                write!(
                    f,
                    "steps {} and {} use resource {} without an order",
                    first.index(),
                    second.index(),
                    resource.index()
                )
            }
            Self::Memory { first, second, resource } => write!(
                f,
                "step {} reuses memory for resource {} while step {} may still use it",
                second.index(),
                resource.index(),
                first.index()
            ),
            Self::NotOwned { step, resource } => {
                write!(f, "step {} needs resource {}, which another queue owns", step.index(), resource.index())
            }
            Self::NotJoined { queue } => write!(f, "the frame ends without waiting for queue {}", queue.index()),
        }
    }
}

/// Returns all errors in a schedule of `plan`; empty for a correct one.
#[must_use]
pub fn check(plan: &Plan, schedule: &Schedule) -> Vec<Violation> {
    let Schedule { layout, lanes, .. } = schedule;
    if lanes.len() != plan.steps().len() || lanes.iter().any(|lane| lane.index() >= layout.queues.len()) {
        return vec![Violation::OtherPlan];
    }
    let mut found = Vec::new();
    for (step, lane) in plan.step_ids().zip(lanes) {
        let graph = plan.graph();
        let asks = |member: &StepPass| {
            graph.passes()[member.pass.index()].flags.has(PassFlags::MAIN_QUEUE)
                || graph.accesses_of(member.pass).iter().any(|access| graph.has_alias(access.resource))
        };
        let asked = *lane != QueueId::MAIN && plan.passes_of(step).iter().any(asks);
        if asked || !layout.queues[lane.index()].runs(plan.steps()[step.index()].kind) {
            found.push(Violation::WrongQueue { step });
        }
    }
    let reached = reached(schedule);
    let ordered = |first: StepId, second: StepId| reached[first.index()][second.index()];
    for second in plan.step_ids() {
        for first in plan.step_ids().take(second.index()).filter(|first| !ordered(*first, second)) {
            found.extend(touched_by_both(plan, first, second).map(|resource| Violation::Unordered {
                first,
                second,
                resource,
            }));
            found.extend(memory_of_both(plan, first, second).map(|resource| Violation::Memory {
                first,
                second,
                resource,
            }));
        }
    }
    // Also of planes that are attached without an access.
    let late = plan.barriers().iter().filter(|row| !row.after.is_none() && !ordered(row.after, row.before));
    found.extend(late.map(|row| Violation::Unordered { first: row.after, second: row.before, resource: row.resource }));
    found.extend(not_owned(plan, schedule));
    for queue in layout.ids().skip(1) {
        let last = lanes.iter().rposition(|lane| *lane == queue).map(StepId::at);
        if last.is_some_and(|last| !schedule.joins.contains(&last)) {
            found.push(Violation::NotJoined { queue });
        }
    }
    found
}

/// Returns all errors in memory shared by a schedule: pairs of overlapping resources whose steps are not ordered.
#[must_use]
pub fn check_memory(plan: &Plan, schedule: &Schedule, memory: &SharedMemory) -> Vec<Violation> {
    let reached = reached(schedule);
    let steps_of = |resource: ResourceId| -> Vec<StepId> {
        plan.step_ids().filter(|step| accesses(plan, *step).any(|access| access.resource == resource)).collect()
    };
    let lies = |resource: ResourceId| {
        let bytes = memory.sizes[resource.index()].max(1);
        memory.offset(resource).map(|offset| offset..offset + bytes)
    };
    let is_texture = |resource: ResourceId| plan.graph().resources()[resource.index()].desc.texture().is_some();
    let mut found = Vec::new();
    for second in plan.graph().resource_ids() {
        for first in plan.graph().resource_ids().take(second.index()) {
            let (Some(a), Some(b)) = (lies(first), lies(second)) else { continue };
            if is_texture(first) != is_texture(second) || a.end <= b.start || b.end <= a.start {
                continue;
            }
            let [ours, theirs] = [steps_of(first), steps_of(second)];
            let apart = |from: &[StepId], to: &[StepId]| {
                from.iter().find_map(|a| to.iter().find(|b| !reached[a.index()][b.index()]).map(|b| (*a, *b)))
            };
            if let (Some((a, b)), Some(_)) = (apart(&ours, &theirs), apart(&theirs, &ours)) {
                found.push(Violation::Memory { first: a, second: b, resource: second });
            }
        }
    }
    found
}

/// For each step, the steps that begin only after it has ended, following queues and semaphores.
fn reached(schedule: &Schedule) -> Vec<Vec<bool>> {
    let count = schedule.lanes.len();
    let mut next: Vec<Vec<usize>> = vec![Vec::new(); count];
    for (step, lane) in schedule.lanes.iter().enumerate() {
        next[step].extend((step + 1..count).find(|other| schedule.lanes[*other] == *lane));
    }
    schedule.waits.iter().for_each(|wait| next[wait.after.index()].push(wait.before.index()));
    let from = |start: usize| {
        let (mut seen, mut open) = (vec![false; count], vec![start]);
        while let Some(step) = open.pop() {
            for other in &next[step] {
                if !std::mem::replace(&mut seen[*other], true) {
                    open.push(*other);
                }
            }
        }
        seen
    };
    (0..count).map(from).collect()
}

fn accesses(plan: &Plan, step: StepId) -> impl Iterator<Item = &Access> {
    plan.passes_of(step).iter().flat_map(|member| plan.graph().accesses_of(member.pass))
}

fn touched_by_both(plan: &Plan, first: StepId, second: StepId) -> impl Iterator<Item = ResourceId> {
    let conflict = move |a: &&Access| {
        accesses(plan, second).any(|b| {
            let same = a.resource == b.resource && plan.graph().overlap(a.resource, &a.range, &b.range);
            // A layout transition counts as a write.
            let moves =
                |step| plan.barriers().iter().any(|x| (x.before, x.resource) == (step, a.resource) && x.from != x.to);
            same && (a.mode.writes() || b.mode.writes() || moves(first) || moves(second))
        })
    };
    accesses(plan, first).filter(conflict).map(|access| access.resource)
}

fn memory_of_both(plan: &Plan, first: StepId, second: StepId) -> impl Iterator<Item = ResourceId> {
    let kind = |r: ResourceId| plan.graph().resources()[r.index()].desc.texture().is_some();
    let bytes = |r: ResourceId| match plan.resources()[r.index()].placement {
        Placement::Heap { offset } => Some(offset..offset.saturating_add(plan.resources()[r.index()].bytes.max(1))),
        _ => None,
    };
    let shares = move |a: ResourceId, b: ResourceId| {
        let of = |r: ResourceId| plan.resources()[r.index()].placement;
        match (of(a), of(b)) {
            (Placement::Slot(a), Placement::Slot(b)) => a == b,
            (Placement::Heap { .. }, Placement::Heap { .. }) if kind(a) == kind(b) || !plan.caps().separate_heaps => {
                bytes(a).zip(bytes(b)).is_some_and(|(a, b)| a.start < b.end && b.start < a.end)
            }
            _ => false,
        }
    };
    let taken =
        move |b: &&Access| accesses(plan, first).any(|a| a.resource != b.resource && shares(a.resource, b.resource));
    accesses(plan, second).filter(taken).map(|access| access.resource)
}

/// Tracks the owner of each exclusively owned resource from step to step.
fn not_owned(plan: &Plan, schedule: &Schedule) -> Vec<Violation> {
    let mut found = Vec::new();
    for resource in plan.graph().resource_ids().filter(|r| !schedule.concurrent.contains(r)) {
        let placement = plan.resources()[resource.index()].placement;
        let lives_on = matches!(placement, Placement::Own | Placement::External);
        if !lives_on && !matches!(placement, Placement::Slot(_) | Placement::Heap { .. }) {
            continue;
        }
        let transfers = || schedule.transfers.iter().filter(|transfer| transfer.resource == resource);
        let mut owner = lives_on.then_some(QueueId::MAIN);
        for step in plan.step_ids() {
            let lane = schedule.lanes[step.index()];
            for access in accesses(plan, step).filter(|access| access.resource == resource) {
                let keeps = access.needs_contents() || access.range != framegraph::Range::ALL;
                let moved = transfers().any(|t| t.to == (lane, Some(step)) && Some(t.from.0) == owner);
                if keeps && owner.is_some_and(|owner| owner != lane) && !moved {
                    found.push(Violation::NotOwned { step, resource });
                }
                owner = if access.mode.writes() || owner.is_some() { Some(lane) } else { owner };
            }
        }
        let back = transfers().any(|transfer| transfer.to == (QueueId::MAIN, None));
        if lives_on && owner != Some(QueueId::MAIN) && !back {
            found.push(Violation::NotOwned { step: StepId::NONE, resource });
        }
    }
    found
}
