//! Which resource has which range of memory, while the frame runs: each takes its range from those before it.

use crate::id::ResourceId;

/// A byte range of one heap, or a slot of the pool, with the resource that has it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Owned {
    /// Number of the heap or slot; ranges of two never overlap.
    pub(crate) heap: u32,
    /// First byte.
    pub(crate) start: u64,
    /// One past the last byte.
    pub(crate) end: u64,
    /// The resource that used the range last.
    pub(crate) resource: ResourceId,
}

/// Gives a resource its range in `owned`, which is sorted and without overlaps; `lost` is told each resource that had a
/// part of it, from the lowest byte up.
pub(crate) fn take_over(owned: &mut Vec<Owned>, own: Owned, mut lost: impl FnMut(ResourceId)) {
    let first = owned.partition_point(|o| (o.heap, o.end) <= (own.heap, own.start));
    let count = owned[first..].iter().take_while(|o| o.heap == own.heap && o.start < own.end).count();
    let covered = &owned[first..first + count];
    covered.iter().for_each(|o| lost(o.resource));
    // What sticks out on either side keeps its owner.
    let left = covered.first().filter(|o| o.start < own.start).map(|o| Owned { end: own.start, ..*o });
    let right = covered.last().filter(|o| o.end > own.end).map(|o| Owned { start: own.end, ..*o });
    owned.splice(first..first + count, left.into_iter().chain([own]).chain(right));
}
