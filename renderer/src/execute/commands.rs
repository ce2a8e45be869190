//! Recorded commands of a frame.

use framegraph::StepId;
use wgpu::{CommandBuffer, CommandEncoder, Queue, SubmissionIndex};

/// Commands of a frame, recorded but not submitted.
///
/// Consists of one command buffer. If textures share memory ([`framegraph::Alias::Heap`]), there is one more for each
/// time that memory is reused.
#[must_use = "a frame whose commands are not submitted is not drawn"]
#[derive(Debug)]
pub struct FrameCommands {
    buffers: CommandList,
    /// True if each command buffer must be submitted on its own.
    separate: bool,
}

impl FrameCommands {
    pub(crate) fn new(buffers: CommandList, separate: bool) -> Self {
        Self { buffers, separate }
    }

    /// Submits the commands in order, between the caller's command buffers `before` and `after`.
    ///
    /// Uses a single submission if the driver keeps the order of commands that access shared memory through different
    /// textures. Mesa's llvmpipe before version 25 does not, and gets one submission per command buffer.
    pub fn submit(
        self,
        queue: &Queue,
        before: impl IntoIterator<Item = CommandBuffer>,
        after: impl IntoIterator<Item = CommandBuffer>,
    ) -> SubmissionIndex {
        let Self { buffers: CommandList { first, last }, separate } = self;
        if !separate {
            return queue.submit(before.into_iter().chain(first).chain(last).chain(after));
        }
        let mut before = Some(before);
        for buffer in first {
            queue.submit(before.take().into_iter().flatten().chain([buffer]));
        }
        queue.submit(before.into_iter().flatten().chain(last).chain(after))
    }

    /// Returns the command buffers. The caller must submit them in this order on the device's queue, before the next
    /// frame of the executor is recorded. Other command buffers may be submitted in between.
    ///
    /// # Errors
    /// Returns the commands unchanged if each command buffer must be submitted on its own (Mesa's llvmpipe before
    /// version 25 with [`framegraph::Alias::Heap`]). Use [`FrameCommands::submit`] in that case.
    pub fn into_buffers(self) -> Result<Vec<CommandBuffer>, Self> {
        if self.separate { Err(self) } else { Ok(self.buffers.into_iter().collect()) }
    }

    /// Returns the number of command buffers.
    pub fn buffers(&self) -> usize {
        self.buffers.first.len() + usize::from(self.buffers.last.is_some())
    }
}

/// Command buffers in order. A list of one allocates nothing.
#[derive(Debug, Default)]
pub(crate) struct CommandList {
    /// All but the last.
    first: Vec<CommandBuffer>,
    last: Option<CommandBuffer>,
}

impl CommandList {
    /// Adds a command buffer.
    pub(crate) fn push(&mut self, buffer: CommandBuffer) {
        self.first.extend(self.last.replace(buffer));
    }

    /// Returns the command buffers in order.
    pub(crate) fn into_iter(self) -> impl Iterator<Item = CommandBuffer> {
        self.first.into_iter().chain(self.last)
    }
}

/// Destination of the recorded commands of a frame.
pub(crate) enum Destination<'d> {
    /// Into command buffers of the executor, on several threads if that is faster.
    Own,
    /// Into command buffers of the executor, on this thread. The function is called after each step with the number of
    /// pipelines created so far.
    Stepwise(&'d mut dyn FnMut(StepId, u64)),
    /// Into the caller's encoder.
    Encoder(&'d mut CommandEncoder),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::gpu::Gpu;

    #[test]
    fn separate_submissions_return_no_buffers() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        let commands = |separate| {
            let mut buffers = CommandList::default();
            (0..2).for_each(|_| buffers.push(gpu.device.create_command_encoder(&Default::default()).finish()));
            FrameCommands::new(buffers, separate)
        };
        assert_eq!(commands(false).into_buffers().map(|buffers| buffers.len()).ok(), Some(2));
        let back = commands(true).into_buffers().err().ok_or("handed out")?;
        assert_eq!(back.buffers(), 2);
        back.submit(&gpu.queue, [], []);
        Ok(())
    }
}
