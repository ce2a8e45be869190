//! Memory that goes from one resource to another within a queue: semaphores order queues, and not a queue's own work.

use crate::hazards::accesses_by_resource;
use crate::memory::SharedMemory;
use crate::schedule::Schedule;
use framegraph::{Plan, ResourceId, StepId};

/// A resource gets memory of another that the queue of a step has touched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HandOver {
    /// The step that touches `to`, with none before it that does.
    pub before: StepId,
    /// Who had the memory.
    pub from: ResourceId,
    /// Who gets it.
    pub to: ResourceId,
}

/// The hand-overs of memory that is shared by a schedule, in the order of the steps that wait. Where another queue touched what lay
/// there, a semaphore of the schedule is behind it, and nothing is said here.
pub fn hand_overs(plan: &Plan, schedule: &Schedule, shared: &SharedMemory) -> Vec<HandOver> {
    let touched = accesses_by_resource(plan);
    let is_texture = |resource: usize| plan.graph().resources()[resource].desc.texture().is_some();
    let span = |resource: usize| {
        let begin = shared.offsets.get(resource).copied().flatten()?;
        Some((is_texture(resource), begin, begin + plan.resources()[resource].bytes))
    };
    let placed: Vec<_> = (0..touched.len()).filter_map(|resource| Some((resource, span(resource)?))).collect();
    let mut found = Vec::new();
    for (to, (kind, begin, end)) in &placed {
        let steps = || touched[*to].iter().map(|(step, _)| *step);
        let mut firsts: Vec<u32> =
            steps().filter(|step| !steps().any(|other| schedule.order.is_before(other, *step))).collect();
        firsts.dedup();
        for step in firsts {
            let queue = schedule.lanes[step as usize];
            let had = placed.iter().filter(|(from, (other, other_begin, other_end))| {
                let overlap = from != to && other == kind && other_begin < end && begin < other_end;
                let mut here = touched[*from].iter().filter(|(own, _)| schedule.lanes[*own as usize] == queue);
                overlap && here.any(|(own, _)| *own < step)
            });
            found.extend(had.map(|(from, _)| HandOver {
                before: StepId::at(step as usize),
                from: ResourceId::at(*from),
                to: ResourceId::at(*to),
            }));
        }
    }
    found.sort_by_key(|row| row.before);
    found
}
