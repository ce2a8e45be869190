//! Frames that the caller submits.

use super::{Executor, check};
use crate::execute::commands::{Destination, FrameCommands};
use crate::execute::error::ExecuteError;
use crate::execute::steps::Passes;
use crate::frame::Frame;
use crate::resources::imports::Imports;
use framegraph::Plan;
use wgpu::CommandEncoder;

impl Executor {
    /// Records a frame and returns its commands. The caller submits them and then calls [`Executor::submitted`].
    /// Otherwise the frame counts as not executed, and histories do not advance.
    ///
    /// In between, the caller may record and submit other commands. They may use results of the frame
    /// ([`Executor::texture`]) if they are submitted after it.
    ///
    /// The caller must not destroy imports. It must not record, execute or inspect another frame with this executor,
    /// which would overwrite uniforms and textures. If it does, the returned commands must be dropped. Errors at
    /// submission are reported to the caller's error scopes.
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
    ///     // Each one has to be submitted separately.
    ///     Err(commands) => drop(commands.submit(&gpu.queue, all.drain(..), [])),
    /// }
    /// all.push(engine());
    /// gpu.queue.submit(all);
    /// executor.submitted();
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Fails like [`Executor::execute`].
    pub fn record<W: ?Sized>(
        &mut self,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
    ) -> Result<FrameCommands, ExecuteError> {
        self.record_to(plan, frame, world, imports, Destination::Own)
    }

    /// Records a frame into the caller's command encoder, on this thread. The caller finishes and submits the encoder
    /// and then calls [`Executor::submitted`]. The restrictions of [`Executor::record`] apply.
    ///
    /// wgpu reports invalid commands when the encoder is finished, to the caller's error scopes.
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
    /// let mut encoder = gpu.device.create_command_encoder(&Default::default());
    /// encoder.insert_debug_marker("commands of the engine");
    /// executor.record_into(&plan, &frame, &(), &Imports::new(), &mut encoder)?;
    /// gpu.queue.submit([encoder.finish()]);
    /// executor.submitted();
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Fails like [`Executor::execute`], and with [`ExecuteError::SharedMemory`] for plans with
    /// [`framegraph::Alias::Heap`]. After an error, the encoder has a part of the frame and must be dropped.
    pub fn record_into<W: ?Sized>(
        &mut self,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
        encoder: &mut CommandEncoder,
    ) -> Result<(), ExecuteError> {
        self.record_to(plan, frame, world, imports, Destination::Encoder(encoder)).map(drop)
    }

    fn record_to<W: ?Sized>(
        &mut self,
        plan: &Plan,
        frame: &Frame<W>,
        world: &W,
        imports: &Imports,
        to: Destination<'_>,
    ) -> Result<FrameCommands, ExecuteError> {
        check(plan, frame)?;
        let commands = self.record_frame(plan, &Passes { frame, world, extra: None }, imports, to)?;
        let watch = self.gpu.watch("uploading the constants of a frame");
        self.upload();
        if let Err(error) = watch.end(self.gpu.errors()) {
            self.discard_frame();
            return Err(self.execute_error(plan, error));
        }
        self.unsubmitted = true;
        Ok(commands)
    }

    /// Reports that the commands last returned by [`Executor::record`] were submitted. Advances histories and pools.
    /// Does nothing if there are no such commands.
    pub fn submitted(&mut self) {
        if std::mem::take(&mut self.unsubmitted) {
            self.end_frame();
        }
    }
}
