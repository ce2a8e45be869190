//! The passes as a graph, compiled once and executed in every frame.

use crate::shared::{Case, FACTOR, FIRST, NEXT, TEXELS};
use framegraph::{
    ClearValue, DeclareError, Extent, Format, Intent, Options, Pass, PassBuilder, Plan, Scratch, Texture, TextureDesc,
    View, recompile,
};
use framegraph_wgpu::{Cx, Executor, ExecutorOptions, Frame, Gpu, Imports, Raster, Record, RecordError, Workers};
use std::error::Error;

struct Draw {
    before: Option<Texture>,
    draws: u32,
}

impl Pass for Draw {
    type Io = (Option<View>, Texture);

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Self::Io, DeclareError> {
        let before = self.before.map(|before| pass.sampled(before)).transpose()?;
        let desc = TextureDesc::new(Extent::absolute(TEXELS, TEXELS), Format::Rgba8Unorm);
        let drawn = pass.texture("picture", desc);
        Ok((before, pass.color(drawn, Intent::Clear(ClearValue::BLACK))?))
    }
}

impl<W: ?Sized> Record<W> for Draw {
    fn record(&self, (before, _): &Self::Io, _: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let pipeline = cx.raster_pipeline(&Raster::new(if before.is_some() { NEXT } else { FIRST }))?;
        let group = match before {
            Some(before) => {
                let bindings = [(0, cx.view(*before)?.into()), (1, cx.uniform(&FACTOR))];
                Some(cx.bind_group(pipeline.group(0), &bindings))
            }
            None => None,
        };
        let pass = cx.render_pass()?;
        pass.set_pipeline(&pipeline);
        if let Some(group) = &group {
            pass.set_bind_group(0, group, &[]);
        }
        (0..self.draws).for_each(|_| pass.draw(0..3, 0..1));
        Ok(())
    }
}

/// A frame with its plan.
pub struct Executed {
    frame: Frame<()>,
    plan: Plan,
    executor: Executor,
}

/// Declares the passes, each of which reads the picture of its predecessor.
pub fn declare(frame: &mut Frame, case: Case) -> Result<(), DeclareError> {
    let mut before = None;
    for _ in 0..case.passes {
        before = Some(frame.add("draw", Draw { before, draws: case.draws })?.1);
    }
    before.map_or(Ok(()), |last| frame.graph_mut().export(last))
}

impl Executed {
    /// Declares and compiles the frame.
    pub fn new(gpu: &Gpu, case: Case, timing: bool) -> Result<Self, Box<dyn Error>> {
        let mut frame = Frame::<()>::new();
        declare(&mut frame, case)?;
        let (mut plan, options) = (Plan::new(), Options::for_frame(TEXELS, TEXELS));
        recompile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
        assert_eq!(plan.counts().steps as usize, case.passes, "what is compared is a step a pass");
        let executor = Executor::with(gpu, ExecutorOptions { timing, ..ExecutorOptions::default() });
        Ok(Self { frame, plan, executor })
    }

    /// Records on `threads` threads from now on: always, or only where it is measured to be faster.
    pub fn on_threads(mut self, threads: usize, always: bool) -> Result<Self, Box<dyn Error>> {
        let workers = Workers::with_threads(threads)?;
        self.frame.allow_threads();
        match always {
            true => self.executor.force_record_on(workers),
            false => self.executor.record_on(Some(workers)),
        }
        Ok(self)
    }

    /// Returns the number of threads that recorded the last frame.
    pub fn threads(&self) -> usize {
        self.executor.recording_threads()
    }

    /// Executes one frame.
    pub fn frame(&mut self) -> Result<(), Box<dyn Error>> {
        self.executor.execute(&self.plan, &self.frame, &(), &Imports::new())?;
        Ok(())
    }
}
