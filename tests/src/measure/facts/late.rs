//! Frames in a row whose facts are decided by what frames before were measured to have.

use super::{Case, Drawn, Easel};
use framegraph::{Extent, Format, Options, Plan, Target, TextureDesc, recompile};
use framegraph_passes::facts::{Around, EffectSet, FactInput, FactMemory, Facts, decide};
use framegraph_passes::measure::{Measurement, Measuring};
use framegraph_passes::view::ViewSettings;
use framegraph_passes::{CameraView, FrameIo, Settings, ViewId, World, standard};
use framegraph_wgpu::{Frame, Gpu, Imports, read_texture};
use std::error::Error;

/// A case that is drawn frame after frame.
#[derive(Debug)]
pub struct InARow {
    drawn: Drawn,
    easel: Easel,
    /// What is on its way.
    pub measuring: Measuring,
    memory: FactMemory,
    plan: Plan,
    last: Option<FrameIo>,
}

impl InARow {
    /// The case before its first frame.
    pub fn new(gpu: &Gpu, drawn: Drawn) -> Self {
        let (measuring, memory) = (Measuring::new(), FactMemory::default());
        Self { drawn, easel: Easel::new(gpu), measuring, memory, plan: Plan::new(), last: None }
    }

    /// What is drawn.
    pub fn case(&self) -> &Case {
        &self.drawn.case
    }

    /// Forgets what was decided, so that the next frame decides at once.
    pub fn forget(&mut self) {
        self.memory = FactMemory::default();
    }

    /// Declares, decides and executes a frame, and begins to read back what it measures. Never waits.
    ///
    /// # Errors
    /// What the device refuses.
    pub fn next(&mut self, asked: &Settings, seen: &ViewSettings) -> Result<(Facts, Measurement), Box<dyn Error>> {
        let Self { drawn: Drawn { case, survey, world, .. }, easel, measuring, memory, plan, last } = self;
        let measured = measuring.known(&easel.gpu)?;
        let input = FactInput {
            scene: &case.scene,
            survey,
            around: Around::from(&world.lighting.image),
            background: &case.background,
            views: std::slice::from_ref(seen),
            settings: asked,
            measured,
            forced: EffectSet::NONE,
            most_codes: FactInput::MOST_CODES,
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

    /// Lets the device come so near that at most two frames are on their way, as showing frames does; asks, and never waits.
    ///
    /// # Errors
    /// When the device is lost.
    pub fn show(&mut self) -> Result<(), Box<dyn Error>> {
        while self.measuring.counts().come + 2 < self.measuring.counts().begun {
            self.measuring.known(&self.easel.gpu)?;
            std::thread::sleep(std::time::Duration::from_micros(200));
        }
        Ok(())
    }

    /// The picture of the last frame, waited for.
    ///
    /// # Errors
    /// When there was none, or the device fails.
    pub fn picture(&self) -> Result<Vec<u8>, Box<dyn Error>> {
        let io = self.last.ok_or("no frame was drawn")?;
        let texture = self.easel.executor.texture(&self.plan, io.output).ok_or("the frame left no picture")?;
        Ok(read_texture(&self.easel.gpu, texture)?.rgba8())
    }
}
