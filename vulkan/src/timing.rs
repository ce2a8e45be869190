//! Timestamps around steps.

use crate::driver::Object;
use crate::error::Error;
use crate::gpu::Gpu;
use crate::lanes::FrameSlot;

/// Reads the timestamps of the slot's earlier frame, which the GPU has finished.
pub(crate) fn read(gpu: &Gpu, slot: &FrameSlot, times_us: &mut Vec<Option<f64>>) -> Result<(), Error> {
    let Some((pool, _, count)) = slot.queries else { return Ok(()) };
    if count == 0 {
        times_us.clear();
        return Ok(());
    }
    let ticks = gpu.shared.driver.ticks(pool, count)?;
    let period_us = f64::from(gpu.shared.properties.limits.timestamp_period) * 1e-3;
    let step = |pair: &[Option<u64>]| Some(pair[1]?.wrapping_sub(pair[0]?) as f64 * period_us);
    *times_us = ticks.chunks_exact(2).map(step).collect();
    Ok(())
}

/// Makes room for the timestamps of a frame, none of which is in use before [`end`]. Does nothing if a queue has none.
pub(crate) fn begin(gpu: &Gpu, slot: &mut FrameSlot, steps: u32) -> Result<(), Error> {
    let bits = |family: u32| gpu.shared.families.get(family as usize).map_or(0, |row| row.timestamp_valid_bits);
    if gpu.shared.queues.iter().any(|queue| bits(queue.family) == 0) {
        return Ok(());
    }
    let count = 2 * steps;
    match slot.queries {
        Some((pool, capacity, _)) if capacity >= count => slot.queries = Some((pool, capacity, 0)),
        known => {
            if let Some((pool, ..)) = known {
                gpu.shared.driver.destroy(Object::QueryPool(pool));
                slot.queries = None;
            }
            slot.queries = Some((gpu.shared.driver.timestamps(count)?, count, 0));
        }
    }
    Ok(())
}

/// Marks the timestamps of a complete frame as in use. A frame that fails may not have reset its timestamps.
pub(crate) fn end(slot: &mut FrameSlot, steps: u32) {
    if let Some((.., count)) = &mut slot.queries {
        *count = 2 * steps;
    }
}
