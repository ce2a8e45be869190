//! Ownership: what moves from one family of queues to another with its contents, and what several read at once.

use crate::hazards::accesses_by_resource;
use crate::layout::QueueId;
use framegraph::{Placement, Plan, ResourceId, StepId};

/// A resource goes from one queue to another and keeps its contents: released behind a step of the one, acquired in front of a
/// step of the other (Vulkan 1.3, 7.7.4). Between the two lies a [`Wait`](crate::Wait), or what it implies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Transfer {
    /// What is handed over, with all its parts.
    pub resource: ResourceId,
    /// The queue that gives it, behind this step; none at the frame's begin, when the first queue has everything.
    pub from: (QueueId, Option<StepId>),
    /// The queue that gets it, in front of this step; none at the frame's end, when the first queue gets back what lives on.
    pub to: (QueueId, Option<StepId>),
}

/// The transfers, and the resources that queues share without: several read them, or parts of them, at the same time.
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
        // Contents of before are there where something outlives frames.
        let mut holds = outlives;
        for (step, access) in accesses {
            let lane = lanes[*step as usize];
            let here = StepId::at(*step as usize);
            if lane != owner.0 && holds && (access.mode.needs_contents() || !is_whole(access)) {
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

/// Whether steps on different queues touch it with no write of all of it between them that would order them: two reads of the
/// same contents, or accesses of different parts.
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
