//! Phase 8, memory statistics: allocated bytes, and their lower bound, the maximum of live bytes.

use crate::id::StepId;
use crate::plan::{Memory, Placement, Planned};
use crate::resource::Kind;

/// Memory statistics, updated while resources are placed step by step.
#[derive(Debug)]
pub(crate) struct MemoryStats {
    memory: Memory,
    /// Sum of the sizes of all resources that share memory.
    wanted: u128,
    /// Bytes that are live now. Wraps around if `wanted` exceeds 64 bits, and is unused then.
    live: u64,
}

impl MemoryStats {
    /// Creates empty statistics.
    pub(crate) fn new() -> Self {
        Self { memory: Memory { optimal: true, ..Memory::default() }, wanted: 0, live: 0 }
    }

    /// Counts a resource that does not share memory: memoryless, inlined, exported, or a history.
    #[inline(never)]
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

    /// Counts a resource that shares memory.
    #[inline]
    pub(crate) fn want(&mut self, bytes: u64) {
        self.wanted += u128::from(bytes);
    }

    /// Marks a resource as live.
    #[inline]
    pub(crate) fn begin(&mut self, bytes: u64) {
        self.live = self.live.wrapping_add(bytes);
    }

    /// Ends the list of resources that become live at `step`.
    #[inline]
    pub(crate) fn begun(&mut self, step: StepId) {
        if self.live > self.memory.lower_bound_bytes {
            (self.memory.lower_bound_bytes, self.memory.peak) = (self.live, step);
        }
    }

    /// Marks a resource as no longer live.
    #[inline]
    pub(crate) fn end(&mut self, bytes: u64) {
        self.live = self.live.wrapping_sub(bytes);
    }

    /// Counts allocated memory.
    #[inline]
    pub(crate) fn take(&mut self, bytes: u64) {
        self.memory.bytes = self.memory.bytes.saturating_add(bytes);
    }

    /// Returns the bytes saved by memoryless attachments and inlining, and the bytes that outlive the frame.
    pub(crate) fn apart_bytes(&self) -> (u64, u64) {
        (self.memory.avoided_bytes, self.memory.own_bytes)
    }

    /// Returns the statistics of a plan whose `resources` are placed in slots.
    pub(crate) fn finish(mut self, steps: usize, resources: &[Planned]) -> Memory {
        self.memory.unaliased_bytes = saturated(self.wanted);
        if self.wanted > u128::from(u64::MAX) {
            (self.memory.lower_bound_bytes, self.memory.peak) = peak(steps, resources);
        }
        self.memory
    }
}

/// Computes the maximum of live bytes in slots, and its step, without overflow.
#[cold]
fn peak(steps: usize, resources: &[Planned]) -> (u64, StepId) {
    let mut changes = vec![(0u128, 0u128); steps + 1];
    for row in resources.iter().filter(|row| matches!(row.placement, Placement::Slot(_))) {
        changes[row.first.index()].0 += u128::from(row.bytes);
        changes[row.last.index() + 1].1 += u128::from(row.bytes);
    }
    let (mut live, mut most) = (0, (0, StepId::NONE));
    for (step, (begun, ended)) in changes.iter().enumerate().take(steps) {
        live = live + begun - ended;
        if live > u128::from(most.0) {
            most = (saturated(live), StepId::at(step));
        }
    }
    most
}

fn saturated(bytes: u128) -> u64 {
    u64::try_from(bytes).unwrap_or(u64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::access::Usage;
    use crate::id::SlotId;

    /// Computes the statistics of resources given as (first step, last step, bytes).
    fn collected(lives: &[(usize, usize, u64)]) -> Memory {
        let row = |&(first, last, bytes): &(usize, usize, u64)| Planned {
            first: StepId::at(first),
            last: StepId::at(last),
            usage: Usage::NONE,
            format: None,
            srgb_views: false,
            bytes,
            placement: Placement::Slot(SlotId::at(0)),
        };
        let (mut stats, steps) = (MemoryStats::new(), 4);
        lives.iter().for_each(|life| stats.want(life.2));
        for step in 0..steps {
            lives.iter().filter(|life| life.0 == step).for_each(|life| stats.begin(life.2));
            stats.begun(StepId::at(step));
            lives.iter().filter(|life| life.1 == step).for_each(|life| stats.end(life.2));
        }
        stats.finish(steps, &lives.iter().map(row).collect::<Vec<_>>())
    }

    #[test]
    fn the_peak_is_the_first_step_with_the_most_live_bytes() {
        let memory = collected(&[(0, 1, 5), (1, 2, 3), (2, 3, 4), (3, 3, 4)]);
        assert_eq!((memory.lower_bound_bytes, memory.peak), (8, StepId::at(1)));
        assert_eq!(memory.unaliased_bytes, 16);
    }

    #[test]
    fn more_bytes_than_64_bits_count_are_told_apart() {
        let most = u64::MAX;
        let memory = collected(&[(0, 0, 7), (1, 1, most - 1), (2, 3, most), (3, 3, 9)]);
        // Live bytes: 7, 2⁶⁴ − 2, 2⁶⁴ − 1, then more than 64 bits can represent.
        assert_eq!((memory.lower_bound_bytes, memory.peak), (most, StepId::at(3)));
        assert_eq!(memory.unaliased_bytes, most);
    }
}
