//! The commands of a frame on their way to the queue.

use wgpu::{CommandBuffer, Queue, SubmissionIndex};

/// The commands of a frame, recorded and not yet submitted. One command buffer, unless textures share memory
/// ([`framegraph::Alias::Heap`]): then one ends wherever memory changes hands.
#[must_use = "a frame whose commands are not submitted is not drawn"]
#[derive(Debug)]
pub struct FrameCommands {
    buffers: Vec<CommandBuffer>,
    /// Each is a submission of its own.
    apart: bool,
}

impl FrameCommands {
    pub(crate) fn new(buffers: Vec<CommandBuffer>, apart: bool) -> Self {
        Self { buffers, apart }
    }

    /// Submits them in order, with commands of the caller's `before` and `behind` them; all at once where the driver keeps the
    /// order of commands that touch one memory through different textures. Mesa's llvmpipe before version 25 does not, and
    /// gets each command buffer apart.
    pub fn submit(
        self,
        queue: &Queue,
        before: impl IntoIterator<Item = CommandBuffer>,
        behind: impl IntoIterator<Item = CommandBuffer>,
    ) -> SubmissionIndex {
        let Self { mut buffers, apart } = self;
        let last = buffers.pop();
        if !apart {
            return queue.submit(before.into_iter().chain(buffers).chain(last).chain(behind));
        }
        let mut before = Some(before);
        for buffer in buffers {
            queue.submit(before.take().into_iter().flatten().chain([buffer]));
        }
        queue.submit(before.into_iter().flatten().chain(last).chain(behind))
    }

    /// The command buffers, to be submitted in this order among those of the caller's, however it submits: before the next frame
    /// of the same executor is recorded, on the device's queue.
    ///
    /// # Errors
    /// They come back where each must be a submission of its own (Mesa's llvmpipe before version 25, with
    /// [`framegraph::Alias::Heap`]): then [`FrameCommands::submit`] does it.
    pub fn into_buffers(self) -> Result<Vec<CommandBuffer>, Self> {
        if self.apart { Err(self) } else { Ok(self.buffers) }
    }

    /// How many command buffers they are.
    pub fn buffers(&self) -> usize {
        self.buffers.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::gpu::Gpu;

    #[test]
    fn what_must_be_submitted_apart_is_not_handed_out() -> Result<(), Box<dyn std::error::Error>> {
        let gpu = Gpu::noop()?;
        let commands = |apart| {
            let buffers = [1, 2].map(|_| gpu.device.create_command_encoder(&Default::default()).finish());
            FrameCommands::new(buffers.into(), apart)
        };
        assert_eq!(commands(false).into_buffers().map(|buffers| buffers.len()).ok(), Some(2));
        let back = commands(true).into_buffers().err().ok_or("handed out")?;
        assert_eq!(back.buffers(), 2);
        back.submit(&gpu.queue, [], []);
        Ok(())
    }
}
