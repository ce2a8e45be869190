//! Tracks the last user of each memory range during the frame.

use crate::id::ResourceId;

/// A byte range of a heap, or a slot of the pool, and its last user.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Owned {
    /// Index of the heap or slot. Ranges of different heaps never overlap.
    pub(crate) heap: u32,
    /// First byte.
    pub(crate) start: u64,
    /// One past the last byte.
    pub(crate) end: u64,
    /// The last resource in this range.
    pub(crate) resource: ResourceId,
}

/// Assigns a range to a resource in `owned`, which is sorted and free of overlaps. Calls `lost` for each previous user
/// of a part of it, by increasing offset.
pub(crate) fn take_over(owned: &mut Vec<Owned>, own: Owned, mut lost: impl FnMut(ResourceId)) {
    let first = owned.partition_point(|o| (o.heap, o.end) <= (own.heap, own.start));
    let count = owned[first..].iter().take_while(|o| o.heap == own.heap && o.start < own.end).count();
    let covered = &owned[first..first + count];
    covered.iter().for_each(|o| lost(o.resource));
    // Ranges beyond either end keep their user.
    let left = covered.first().filter(|o| o.start < own.start).map(|o| Owned { end: own.start, ..*o });
    let right = covered.last().filter(|o| o.end > own.end).map(|o| Owned { start: own.end, ..*o });
    owned.splice(first..first + count, left.into_iter().chain([own]).chain(right));
}
