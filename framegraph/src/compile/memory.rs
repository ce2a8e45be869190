//! Phase 8, the certificate: bytes taken, and the peak of live bytes below which no sharing can go.

use crate::graph::Graph;
use crate::id::StepId;
use crate::plan::{Memory, Placement, Planned, Slot};
use crate::resource::Kind;

/// Sums up the memory of a plan whose transient resources are placed. `live` is scratch: bytes by step.
pub(crate) fn memory(
    graph: &Graph,
    steps: usize,
    resources: &[Planned],
    slots: &[Slot],
    live: &mut Vec<i128>,
) -> Memory {
    let mut memory = Memory { optimal: true, ..Memory::default() };
    live.clear();
    live.resize(steps + 1, 0);
    for (index, row) in resources.iter().enumerate() {
        match row.placement {
            Placement::Memoryless | Placement::Inlined => {
                memory.avoided_bytes = memory.avoided_bytes.saturating_add(row.bytes);
            }
            Placement::Slot(_) => {
                memory.unaliased_bytes = memory.unaliased_bytes.saturating_add(row.bytes);
                live[row.first.index()] += i128::from(row.bytes);
                live[row.last.index() + 1] -= i128::from(row.bytes);
            }
            Placement::Own => {
                let ring = match graph.resources[index].kind {
                    Kind::HistoryCurrent { frames } => u64::from(frames) + 1,
                    Kind::HistoryPrevious { .. } => 0,
                    _ => 1,
                };
                memory.own_bytes = memory.own_bytes.saturating_add(row.bytes.saturating_mul(ring));
            }
            // The heap's own figures take the place of the pool's.
            Placement::Unused | Placement::External | Placement::Heap { .. } => {}
        }
    }
    let mut sum = 0i128;
    for (step, change) in live.iter().enumerate().take(steps) {
        sum += change;
        if sum > i128::from(memory.lower_bound_bytes) {
            memory.lower_bound_bytes = u64::try_from(sum).unwrap_or(u64::MAX);
            memory.peak = StepId::at(step);
        }
    }
    memory.bytes = slots.iter().fold(0u64, |sum, slot| sum.saturating_add(slot.bytes));
    memory
}
