//! Consecutive frames whose feature culling uses measurements of earlier frames.

use super::{Case, Drawn, Easel};
use framegraph::{Extent, Format, Options, Plan, Target, TextureDesc, recompile};
use framegraph_passes::effects::exposure::{Measurement, Measuring};
use framegraph_passes::feature_culling::{EffectSet, EnvironmentSummary, FactInput, FactMemory, Facts, decide};
use framegraph_passes::gpu_scene::view::ViewSettings;
use framegraph_passes::{CameraView, FrameIo, Settings, ViewId, World, standard};
use framegraph_wgpu::{Frame, Gpu, Imports, read_texture};
use std::error::Error;

/// A case that is drawn repeatedly.
#[derive(Debug)]
pub struct InARow {
    drawn: Drawn,
    easel: Easel,
    /// Pending measurements.
    pub measuring: Measuring,
    memory: FactMemory,
    plan: Plan,
    last: Option<FrameIo>,
}

impl InARow {
    /// Creates the sequence before its first frame.
    pub fn new(gpu: &Gpu, drawn: Drawn) -> Self {
        let (measuring, memory) = (Measuring::new(), FactMemory::default());
        Self { drawn, easel: Easel::new(gpu), measuring, memory, plan: Plan::new(), last: None }
    }

    /// Returns the case.
    pub fn case(&self) -> &Case {
        &self.drawn.case
    }

    /// Discards earlier decisions, so that the next frame decides anew.
    pub fn forget(&mut self) {
        self.memory = FactMemory::default();
    }

    /// Declares, culls and executes a frame, and starts the readback of its measurements. Never waits.
    ///
    /// # Errors
    /// The device fails.
    pub fn next(&mut self, asked: &Settings, seen: &ViewSettings) -> Result<(Facts, Measurement), Box<dyn Error>> {
        let Self { drawn: Drawn { case, survey, world, .. }, easel, measuring, memory, plan, last } = self;
        let measured = measuring.known(&easel.gpu)?;
        let input = FactInput {
            scene: &case.scene,
            survey,
            around: EnvironmentSummary::from(&world.lighting.image),
            background: &case.background,
            views: std::slice::from_ref(seen),
            settings: asked,
            measured,
            forced: EffectSet::NONE,
            max_steps: FactInput::MAX_CODES,
        };
        let facts = decide(&input, memory);
        let settings = facts.apply(asked);
        let view = CameraView::new(&case.scene, &world.lighting.image, &case.background, seen);
        let stand = view.stand();
        world.set_view(&easel.gpu, ViewId::MAIN, view)?;
        let mut frame = Frame::<World>::new();
        facts.note(frame.graph_mut());
        let output = frame.graph_mut().texture("output", TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb));
        let io = standard(&mut frame, &settings, Target::from(output))?;
        frame.graph_mut().readback(io.output)?;
        let [width, height] = seen.size_px;
        let options = Options::for_frame(width, height);
        recompile(frame.graph(), &easel.gpu.caps(), &options, &mut easel.scratch, plan)?;
        easel.executor.execute(plan, &frame, world, &Imports::new())?;
        measuring.begin(&easel.gpu, (&easel.executor, plan), io.measured, stand)?;
        *last = Some(io);
        Ok((facts, measured))
    }

    /// Polls the device until at most two frames are pending, as presentation does, without waiting.
    ///
    /// # Errors
    /// The device is lost.
    pub fn show(&mut self) -> Result<(), Box<dyn Error>> {
        while self.measuring.counts().come + 2 < self.measuring.counts().begun {
            self.measuring.known(&self.easel.gpu)?;
            std::thread::sleep(std::time::Duration::from_micros(200));
        }
        Ok(())
    }

    /// Waits for the picture of the last frame, and returns it.
    ///
    /// # Errors
    /// No frame was drawn, or the device fails.
    pub fn picture(&self) -> Result<Vec<u8>, Box<dyn Error>> {
        let io = self.last.ok_or("no frame was drawn")?;
        let texture = self.easel.executor.texture(&self.plan, io.output).ok_or("the frame left no picture")?;
        Ok(read_texture(&self.easel.gpu, texture)?.rgba8())
    }
}
