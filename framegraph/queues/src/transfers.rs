//! Ownership of resources: transfers between queue families, and resources used concurrently.

use crate::hazards::accesses_by_resource;
use crate::layout::QueueId;
use framegraph::{Placement, Plan, ResourceId, StepId};

/// A transfer of ownership with contents: released after a step of one queue, acquired before a step of another (Vulkan
/// 1.3, 7.7.4). A [`Wait`](crate::Wait) orders both, directly or indirectly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Transfer {
    /// The whole resource.
    pub resource: ResourceId,
    /// The releasing queue and the step before the release; `None` at the start of the frame, when the first queue owns
    /// everything.
    pub from: (QueueId, Option<StepId>),
    /// The acquiring queue and the step after the acquire; `None` at the end of the frame, when the first queue gets
    /// persistent resources back.
    pub to: (QueueId, Option<StepId>),
}

/// Returns the transfers, and the resources that several queues use concurrently.
pub fn transfers(plan: &Plan, lanes: &[QueueId]) -> (Vec<Transfer>, Vec<ResourceId>) {
    let (mut transfers, mut concurrent) = (Vec::new(), Vec::new());
    for (resource, accesses) in accesses_by_resource(plan).iter().enumerate() {
        let (id, row) = (ResourceId::at(resource), &plan.resources()[resource]);
        let outlives = matches!(row.placement, Placement::Own | Placement::External);
        if accesses.is_empty()
            || matches!(row.placement, Placement::Memoryless | Placement::Inlined | Placement::Unused)
        {
            continue;
        }
        if is_read_by_several(accesses, lanes) {
            concurrent.push(id);
            continue;
        }
        let mut owner = (QueueId::MAIN, None);
        // Resources that outlive frames have initial contents.
        let mut holds = outlives;
        for (step, access) in accesses {
            let lane = lanes[*step as usize];
            let here = StepId::at(*step as usize);
            if lane != owner.0 && holds && (access.needs_contents() || !is_whole(access)) {
                transfers.push(Transfer { resource: id, from: owner, to: (lane, Some(here)) });
            }
            holds |= access.mode.writes();
            owner = (lane, Some(here));
        }
        if outlives && owner.0 != QueueId::MAIN {
            transfers.push(Transfer { resource: id, from: owner, to: (QueueId::MAIN, None) });
        }
    }
    transfers.sort_by_key(|transfer| transfer.to.1.map_or(u32::MAX, |step| step.index() as u32));
    (transfers, concurrent)
}

fn is_whole(access: &framegraph::Access) -> bool {
    access.range == framegraph::Range::ALL
}

/// Returns `true` if steps on different queues use the resource without an ordering write of all of it: two reads of
/// the same contents, or accesses of different parts.
fn is_read_by_several(accesses: &[(u32, framegraph::Access)], lanes: &[QueueId]) -> bool {
    let mut readers: Vec<QueueId> = Vec::new();
    for (step, access) in accesses {
        let lane = lanes[*step as usize];
        if access.mode.writes() && is_whole(access) {
            readers.clear();
            continue;
        }
        if readers.iter().any(|other| *other != lane) {
            return true;
        }
        readers.push(lane);
    }
    false
}
