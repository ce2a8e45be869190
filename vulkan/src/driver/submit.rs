//! Command buffers, submissions, timeline semaphores and query results.

#![allow(unsafe_code, reason = "Vulkan has no safe calls")]

use super::Driver;
use crate::error::Error;
use ash::vk;

/// A value of a timeline semaphore.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct TimelinePoint {
    pub(crate) semaphore: vk::Semaphore,
    pub(crate) value: u64,
}

/// One submission.
#[derive(Debug)]
pub(crate) struct Submission<'a> {
    pub(crate) queue: vk::Queue,
    pub(crate) commands: &'a [vk::CommandBuffer],
    pub(crate) waits: &'a [TimelinePoint],
    pub(crate) signal: TimelinePoint,
    /// Binary semaphores of the engine, for example of a swapchain.
    pub(crate) binary_waits: &'a [vk::Semaphore],
    pub(crate) binary_signals: &'a [vk::Semaphore],
}

impl Driver {
    /// Allocates a command buffer and begins recording.
    pub(crate) fn begin_commands(&self, pool: vk::CommandPool) -> Result<vk::CommandBuffer, Error> {
        let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
        let once = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: D1, D2, D4.
        unsafe {
            let made = self.raw.allocate_command_buffers(&info).map_err(Error::of("a command buffer"))?;
            self.raw.begin_command_buffer(made[0], &once).map_err(Error::of("a command buffer"))?;
            Ok(made[0])
        }
    }

    /// Ends recording.
    pub(crate) fn end_commands(&self, commands: vk::CommandBuffer) -> Result<(), Error> {
        // SAFETY: D4. The commands are being recorded, outside of a render pass.
        unsafe { self.raw.end_command_buffer(commands) }.map_err(Error::of("a command buffer"))
    }

    /// Frees the command buffers of a pool.
    pub(crate) fn free_commands(&self, pool: vk::CommandPool, commands: &[vk::CommandBuffer]) {
        if !commands.is_empty() {
            // SAFETY: D1, D3.
            unsafe { self.raw.free_command_buffers(pool, commands) };
        }
    }

    /// Submits commands.
    pub(crate) fn submit(&self, submission: &Submission<'_>) -> Result<(), Error> {
        let Submission { queue, commands, waits, signal, binary_waits, binary_signals } = submission;
        let (mut wait_semaphores, mut wait_values) = (Vec::new(), Vec::new());
        for point in *waits {
            wait_semaphores.push(point.semaphore);
            wait_values.push(point.value);
        }
        let (mut signal_semaphores, mut signal_values) = (vec![signal.semaphore], vec![signal.value]);
        wait_semaphores.extend_from_slice(binary_waits);
        wait_values.resize(wait_semaphores.len(), 0);
        signal_semaphores.extend_from_slice(binary_signals);
        signal_values.resize(signal_semaphores.len(), 0);
        let stages = vec![vk::PipelineStageFlags::ALL_COMMANDS; wait_semaphores.len()];
        let mut timeline = vk::TimelineSemaphoreSubmitInfo::default()
            .wait_semaphore_values(&wait_values)
            .signal_semaphore_values(&signal_values);
        let info = vk::SubmitInfo::default()
            .command_buffers(commands)
            .wait_semaphores(&wait_semaphores)
            .wait_dst_stage_mask(&stages)
            .signal_semaphores(&signal_semaphores)
            .push_next(&mut timeline);
        // SAFETY: D1, D2, D4. Values of each timeline increase. The engine keeps other threads from the queue
        // (`Gpu::new`).
        unsafe { self.raw.queue_submit(*queue, &[info], vk::Fence::null()) }.map_err(Error::of("a submission"))
    }

    /// Waits until all points are reached.
    pub(crate) fn wait(&self, points: &[TimelinePoint]) -> Result<(), Error> {
        let semaphores: Vec<_> = points.iter().map(|point| point.semaphore).collect();
        let values: Vec<_> = points.iter().map(|point| point.value).collect();
        if semaphores.is_empty() {
            return Ok(());
        }
        let info = vk::SemaphoreWaitInfo::default().semaphores(&semaphores).values(&values);
        // SAFETY: D1, D2.
        unsafe { self.raw.wait_semaphores(&info, u64::MAX) }.map_err(Error::of("waiting for the GPU"))
    }

    /// Returns the timestamps of a pool in ticks; `None` for those that are not available.
    pub(crate) fn ticks(&self, pool: vk::QueryPool, count: u32) -> Result<Vec<Option<u64>>, Error> {
        let mut rows = vec![[0_u64; 2]; count as usize];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WITH_AVAILABILITY;
        // SAFETY: D1. Each row has a value and its availability. `timing::read` passes a count above 0, of queries that a
        // complete frame has reset.
        match unsafe { self.raw.get_query_pool_results(pool, 0, &mut rows, flags) } {
            Ok(()) | Err(vk::Result::NOT_READY) => {}
            Err(result) => return Err(Error::Vulkan { of: "timestamps", result }),
        }
        Ok(rows.iter().map(|[ticks, available]| (*available != 0).then_some(*ticks)).collect())
    }
}
