//! Frames whose commands the caller submits, when and among whichever it likes.

use super::{Executor, check};
use crate::execute::commands::FrameCommands;
use crate::execute::error::ExecuteError;
use crate::execute::steps::Passes;
use crate::frame::Frame;
use crate::resources::imports::Imports;
use framegraph::Plan;

impl Executor {
    /// The first half of [`Executor::execute`]: records a frame and hands out its commands. The caller submits them and then
    /// calls [`Executor::submitted`]; a frame of which it does not say so counts as not executed: histories do not move.
    ///
    /// Between the two the caller may record and submit commands of its own, also such that use what the frame leaves
    /// ([`Executor::texture`]) if they are submitted behind it. It must not destroy imports, and not record, execute or inspect
    /// another frame with this executor, since that takes the constants of this one and the memory that it draws into; commands of
    /// a frame that was left so are to be dropped. What wgpu refuses at submission goes to the caller's own error scopes.
    ///
    /// ```
    /// # use framegraph::{ClearValue, Extent, Format, Intent, Options, Plan, Scratch, TextureDesc, compile};
    /// # use framegraph_wgpu::{Executor, Frame, Gpu, Imports};
    /// # let gpu = Gpu::noop()?;
    /// # let (mut executor, mut frame, mut plan) = (Executor::new(&gpu), Frame::<()>::new(), Plan::new());
    /// # let sky = frame.graph_mut().texture("sky", TextureDesc::new(Extent::FRAME, Format::Rgba8Unorm));
    /// # let clear = Intent::Clear(ClearValue::BLACK);
    /// # let sky = frame.add_fn("clear", |pass| pass.color(sky, clear), |_, _, _| Ok(()))?;
    /// # frame.graph_mut().export(sky)?;
    /// # compile(frame.graph(), &gpu.caps(), &Options::for_frame(8, 8), &mut Scratch::new(), &mut plan)?;
    /// # let engine = || gpu.device.create_command_encoder(&Default::default()).finish();
    /// let commands = executor.record(&plan, &frame, &(), &Imports::new())?;
    /// let mut all = vec![engine()];
    /// match commands.into_buffers() {
    ///     Ok(buffers) => all.extend(buffers),
    ///     // Each has to be a submission of its own here.
    ///     Err(commands) => drop(commands.submit(&gpu.queue, all.drain(..), [])),
    /// }
    /// all.push(engine());
    /// gpu.queue.submit(all);
    /// executor.submitted();
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Executor::execute`].
    pub fn record<W: ?Sized + Sync + 'static>(
        &mut self,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
    ) -> Result<FrameCommands, ExecuteError> {
        check(plan, frame)?;
        let commands = self.record_frame(plan, &Passes { frame, world, extra: None }, imports, None)?;
        let watch = self.gpu.watch("uploading the constants of a frame");
        self.upload();
        if let Err(error) = watch.end(self.gpu.errors()) {
            self.forget_frame();
            return Err(self.told(plan, error));
        }
        self.unsubmitted = true;
        Ok(commands)
    }

    /// The second half: what [`Executor::record`] handed out last was submitted. Histories and pools move on. Without such a
    /// frame it does nothing.
    pub fn submitted(&mut self) {
        if std::mem::take(&mut self.unsubmitted) {
            self.end_frame();
        }
    }
}
