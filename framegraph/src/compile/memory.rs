//! Phase 8, the certificate: bytes taken, and the peak of live bytes below which no sharing can go.

use crate::id::StepId;
use crate::plan::{Memory, Placement, Planned};
use crate::resource::Kind;

/// The sums of a plan's memory, while its resources are placed step by step.
#[derive(Debug)]
pub(crate) struct Tally {
    memory: Memory,
    /// Bytes that are live now; each resource may have 2⁶⁴ − 1.
    live: u128,
}

impl Tally {
    /// Nothing is placed yet.
    pub(crate) fn new() -> Self {
        Self { memory: Memory { optimal: true, ..Memory::default() }, live: 0 }
    }

    /// Counts a resource that takes no part in sharing: what is kept out of memory, and what outlives the frame.
    #[inline]
    pub(crate) fn apart(&mut self, kind: Kind, row: &Planned) {
        match row.placement {
            Placement::Memoryless | Placement::Inlined => {
                self.memory.avoided_bytes = self.memory.avoided_bytes.saturating_add(row.bytes);
            }
            Placement::Own => {
                let ring = match kind {
                    Kind::HistoryCurrent { frames } => u64::from(frames) + 1,
                    Kind::HistoryPrevious { .. } => 0,
                    _ => 1,
                };
                self.memory.own_bytes = self.memory.own_bytes.saturating_add(row.bytes.saturating_mul(ring));
            }
            Placement::Unused | Placement::External | Placement::Slot(_) | Placement::Heap { .. } => {}
        }
    }

    /// A resource that shares memory begins to live.
    #[inline]
    pub(crate) fn begin(&mut self, bytes: u64) {
        self.memory.unaliased_bytes = self.memory.unaliased_bytes.saturating_add(bytes);
        self.live += u128::from(bytes);
    }

    /// All that begin to live at `step` do.
    #[inline]
    pub(crate) fn begun(&mut self, step: StepId) {
        if self.live > u128::from(self.memory.lower_bound_bytes) {
            self.memory.lower_bound_bytes = u64::try_from(self.live).unwrap_or(u64::MAX);
            self.memory.peak = step;
        }
    }

    /// A resource that shares memory is dead from now on.
    #[inline]
    pub(crate) fn end(&mut self, bytes: u64) {
        self.live -= u128::from(bytes);
    }

    /// Takes memory.
    #[inline]
    pub(crate) fn take(&mut self, bytes: u64) {
        self.memory.bytes = self.memory.bytes.saturating_add(bytes);
    }

    /// The sums.
    pub(crate) fn finish(self) -> Memory {
        self.memory
    }
}
