//! Memory sharing on several queues. A resource may reuse memory if every step that uses the previous resource ends
//! before any step that uses the new one begins.

use crate::hazards::accesses_by_resource;
use crate::schedule::Schedule;
use framegraph::{Placement, Plan, ResourceId};

/// Offsets of transient resources in two heaps, one for textures and one for buffers.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SharedMemory {
    /// Offset of each resource in the heap of its kind; `None` for resources without transient memory.
    pub offsets: Vec<Option<u64>>,
    /// Size of each resource in its heap, in bytes.
    pub sizes: Vec<u64>,
    /// Sizes of the texture heap and of the buffer heap, in bytes.
    pub heap_bytes: [u64; 2],
    /// Size without sharing, in bytes.
    pub unaliased_bytes: u64,
}

/// Places the transient resources of a plan that was compiled without aliasing ([`framegraph::Alias::Off`]).
///
/// Resources share memory only if the schedule already orders their steps, so no further waits are needed. Offsets are
/// multiples of `alignment`. The largest resource is placed first, each at the lowest possible offset.
///
/// # Panics
/// Panics if `schedule` belongs to another plan, or if `alignment` is 0.
#[must_use]
pub fn share_memory(plan: &Plan, schedule: &Schedule, alignment: u64) -> SharedMemory {
    let sizes: Vec<u64> = plan.resources().iter().map(|row| row.bytes).collect();
    share_memory_with(plan, schedule, alignment, &sizes)
}

/// Places resources like [`share_memory`], with the size of each resource in bytes, which a driver can pad.
///
/// # Panics
/// Panics if `schedule` belongs to another plan, if `alignment` is 0, or if `sizes` has too few elements.
#[must_use]
pub fn share_memory_with(plan: &Plan, schedule: &Schedule, alignment: u64, sizes: &[u64]) -> SharedMemory {
    let accessed = accesses_by_resource(plan);
    let is_texture = |resource: usize| plan.graph().resources()[resource].desc.texture().is_some();
    let is_transient =
        |resource: &usize| matches!(plan.resources()[*resource].placement, Placement::Slot(_) | Placement::Heap { .. });
    let bytes = |resource: usize| sizes[resource].next_multiple_of(alignment);
    let mut all: Vec<usize> = (0..accessed.len()).filter(is_transient).collect();
    all.sort_by_key(|resource| (std::cmp::Reverse(bytes(*resource)), *resource));
    let over = |a: usize, b: usize| {
        accessed[a]
            .iter()
            .all(|(first, _)| accessed[b].iter().all(|(second, _)| schedule.order.is_before(*first, *second)))
    };
    let mut shared =
        SharedMemory { offsets: vec![None; accessed.len()], sizes: sizes.to_vec(), ..SharedMemory::default() };
    for resource in &all {
        let mut taken: Vec<(u64, u64)> = all
            .iter()
            .filter(|other| is_texture(**other) == is_texture(*resource))
            .filter_map(|other| Some((*other, shared.offsets[*other]?)))
            .filter(|(other, _)| !over(*other, *resource) && !over(*resource, *other))
            .map(|(other, offset)| (offset, offset + bytes(other)))
            .collect();
        taken.sort_unstable();
        let mut offset = 0;
        for (begin, end) in taken {
            if begin >= offset + bytes(*resource) {
                break;
            }
            offset = offset.max(end);
        }
        shared.offsets[*resource] = Some(offset);
        let heap = &mut shared.heap_bytes[usize::from(!is_texture(*resource))];
        *heap = (*heap).max(offset + bytes(*resource));
        shared.unaliased_bytes += bytes(*resource);
    }
    shared
}

impl SharedMemory {
    /// Size of both heaps, in bytes.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.heap_bytes.iter().sum()
    }

    /// Returns the offset of a resource.
    #[must_use]
    pub fn offset(&self, resource: ResourceId) -> Option<u64> {
        self.offsets.get(resource.index()).copied().flatten()
    }
}
