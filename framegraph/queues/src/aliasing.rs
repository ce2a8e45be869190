//! Aliasing barriers within a queue. Semaphores order different queues, but not the work of a single queue.

use crate::hazards::accesses_by_resource;
use crate::memory::SharedMemory;
use crate::schedule::Schedule;
use framegraph::{Plan, ResourceId, StepId};

/// A resource reuses memory of another one that the same queue has used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct AliasingBarrier {
    /// A step that uses `to`, and before which no step uses it.
    pub before: StepId,
    /// The previous resource.
    pub from: ResourceId,
    /// The new resource.
    pub to: ResourceId,
}

/// Returns the aliasing barriers of memory shared by a schedule, in the order of the waiting steps. Uses on other
/// queues are covered by semaphores and not included.
pub fn aliasing_barriers(plan: &Plan, schedule: &Schedule, shared: &SharedMemory) -> Vec<AliasingBarrier> {
    let accessed = accesses_by_resource(plan);
    let is_texture = |resource: usize| plan.graph().resources()[resource].desc.texture().is_some();
    let span = |resource: usize| {
        let begin = shared.offsets.get(resource).copied().flatten()?;
        Some((is_texture(resource), begin, begin + shared.sizes[resource]))
    };
    let placed: Vec<_> = (0..accessed.len()).filter_map(|resource| Some((resource, span(resource)?))).collect();
    let mut found = Vec::new();
    for (to, (kind, begin, end)) in &placed {
        let steps = || accessed[*to].iter().map(|(step, _)| *step);
        let mut firsts: Vec<u32> =
            steps().filter(|step| !steps().any(|other| schedule.order.is_before(other, *step))).collect();
        firsts.dedup();
        for step in firsts {
            let queue = schedule.lanes[step as usize];
            let had = placed.iter().filter(|(from, (other, other_begin, other_end))| {
                let overlap = from != to && other == kind && other_begin < end && begin < other_end;
                let mut here = accessed[*from].iter().filter(|(own, _)| schedule.lanes[*own as usize] == queue);
                overlap && here.any(|(own, _)| *own < step)
            });
            found.extend(had.map(|(from, _)| AliasingBarrier {
                before: StepId::at(step as usize),
                from: ResourceId::at(*from),
                to: ResourceId::at(*to),
            }));
        }
    }
    found.sort_by_key(|row| row.before);
    found
}
