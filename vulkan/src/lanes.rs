//! Command buffers and timeline semaphores of each queue.

use crate::driver::{Dependencies, Object, Submission, TimelinePoint};
use crate::error::Error;
use crate::gpu::{DeviceQueue, Gpu};
use ash::vk;

/// Recording state of one queue.
pub(crate) struct Lane {
    pub(crate) queue: DeviceQueue,
    timeline: TimelinePoint,
    open: Option<vk::CommandBuffer>,
    waits: Vec<TimelinePoint>,
    /// Barriers that are recorded by one command.
    pub(crate) pending: Dependencies,
}

/// Command buffers of a frame, of one queue.
struct Pool {
    raw: vk::CommandPool,
    buffers: Vec<vk::CommandBuffer>,
}

/// Objects of a frame that the GPU may still use.
#[derive(Default)]
pub(crate) struct FrameSlot {
    /// By queue.
    pools: Vec<Pool>,
    /// Timestamps: pool, capacity, and number in use.
    pub(crate) queries: Option<(vk::QueryPool, u32, u32)>,
    pub(crate) garbage: Vec<Object>,
    /// Points at which the GPU has finished the frame.
    pub(crate) done: Vec<TimelinePoint>,
}

/// The queues of an executor.
pub(crate) struct Lanes {
    pub(crate) rows: Vec<Lane>,
    /// Number of submissions so far.
    pub(crate) submissions: u64,
}

impl Lanes {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, Error> {
        let mut lanes = Self { rows: Vec::new(), submissions: 0 };
        for queue in &gpu.shared.queues {
            match gpu.shared.driver.timeline() {
                Ok(semaphore) => lanes.rows.push(Lane {
                    queue: *queue,
                    timeline: TimelinePoint { semaphore, value: 0 },
                    open: None,
                    waits: Vec::new(),
                    pending: Dependencies::default(),
                }),
                Err(error) => {
                    lanes.destroy(gpu);
                    return Err(error);
                }
            }
        }
        Ok(lanes)
    }

    /// Destroys the semaphores. The GPU must have finished.
    pub(crate) fn destroy(&mut self, gpu: &Gpu) {
        for lane in self.rows.drain(..) {
            gpu.shared.driver.destroy(Object::Semaphore(lane.timeline.semaphore));
        }
    }

    /// Returns the command buffer of a queue, with pending barriers recorded.
    pub(crate) fn commands(
        &mut self,
        gpu: &Gpu,
        slot: &mut FrameSlot,
        lane: usize,
    ) -> Result<vk::CommandBuffer, Error> {
        let row = &mut self.rows[lane];
        let commands = match row.open {
            Some(commands) => commands,
            None => {
                let pool = &mut slot.pools[lane];
                let commands = gpu.shared.driver.begin_commands(pool.raw)?;
                pool.buffers.push(commands);
                row.open = Some(commands);
                commands
            }
        };
        if !row.pending.is_empty() {
            gpu.shared.driver.barriers(commands, &std::mem::take(&mut row.pending));
        }
        Ok(commands)
    }

    /// Adds a wait to the next submission of a queue. Submits what is already recorded, which must not wait.
    pub(crate) fn wait(
        &mut self,
        gpu: &Gpu,
        slot: &mut FrameSlot,
        lane: usize,
        point: TimelinePoint,
    ) -> Result<(), Error> {
        if self.rows[lane].open.is_some() || !self.rows[lane].pending.is_empty() {
            self.submit(gpu, slot, lane, &[], &[])?;
        }
        self.rows[lane].waits.push(point);
        Ok(())
    }

    /// Submits what is recorded on a queue. Returns the point that it signals.
    pub(crate) fn submit(
        &mut self,
        gpu: &Gpu,
        slot: &mut FrameSlot,
        lane: usize,
        binary_waits: &[vk::Semaphore],
        binary_signals: &[vk::Semaphore],
    ) -> Result<TimelinePoint, Error> {
        if !self.rows[lane].pending.is_empty() {
            self.commands(gpu, slot, lane)?;
        }
        let row = &mut self.rows[lane];
        let commands: Vec<_> = row.open.take().into_iter().collect();
        for commands in &commands {
            gpu.shared.driver.end_commands(*commands)?;
        }
        let waits = std::mem::take(&mut row.waits);
        let signal = TimelinePoint { value: row.timeline.value + 1, ..row.timeline };
        gpu.shared.driver.submit(&Submission {
            queue: row.queue.raw,
            commands: &commands,
            waits: &waits,
            signal,
            binary_waits,
            binary_signals,
        })?;
        row.timeline = signal;
        self.submissions += 1;
        slot.done.retain(|point| point.semaphore != signal.semaphore);
        slot.done.push(signal);
        Ok(signal)
    }

    /// Returns `true` if something is recorded or waited for on a queue since its last submission.
    pub(crate) fn has_work(&self, lane: usize) -> bool {
        let row = &self.rows[lane];
        row.open.is_some() || !row.waits.is_empty() || !row.pending.is_empty()
    }

    /// Drops everything that is recorded and not submitted.
    pub(crate) fn abandon(&mut self) {
        for row in &mut self.rows {
            row.open = None;
            row.waits.clear();
            row.pending = Dependencies::default();
        }
    }
}

impl FrameSlot {
    /// Waits until the GPU has finished the earlier frame of the slot, and frees its objects.
    pub(crate) fn reclaim(&mut self, gpu: &Gpu) -> Result<(), Error> {
        let driver = &gpu.shared.driver;
        driver.wait(&self.done)?;
        self.done.clear();
        for queue in gpu.shared.queues.iter().skip(self.pools.len()) {
            self.pools.push(Pool { raw: driver.command_pool(queue.family)?, buffers: Vec::new() });
        }
        for pool in &mut self.pools {
            driver.free_commands(pool.raw, &std::mem::take(&mut pool.buffers));
        }
        self.garbage.drain(..).rev().for_each(|object| driver.destroy(object));
        Ok(())
    }

    /// Destroys everything. The GPU must have finished.
    pub(crate) fn destroy(&mut self, gpu: &Gpu) {
        let driver = &gpu.shared.driver;
        self.garbage.drain(..).rev().for_each(|object| driver.destroy(object));
        self.pools.drain(..).for_each(|pool| driver.destroy(Object::CommandPool(pool.raw)));
        if let Some((pool, ..)) = self.queries.take() {
            driver.destroy(Object::QueryPool(pool));
        }
    }
}
