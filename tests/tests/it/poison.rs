//! A bad pixel at the interfaces of the standard frame's stages: it stays local, and no later texture has a NaN pixel.

use crate::stage::{Set, Shot, gpu};
use framegraph::{DeclareError, Intent, Pass, PassBuilder, Plan, Scratch, Target, Texture, TextureDesc, View, compile};
use framegraph_passes::effects::occlusion::{OcclusionSettings, SaoQuality};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::program::full_screen::FullScreen;
use framegraph_passes::program::{Interface, ProgramDesc, Programs};
use framegraph_passes::stages::{Handles, Slot, Stage};
use framegraph_passes::{BloomSettings, DofSettings, Settings, TaaSettings, World, stages};
use framegraph_scene::{Scene, progress};
use framegraph_shaders::Module;
use framegraph_wgpu::inspect::{Inspector, all_targets};
use framegraph_wgpu::{Cx, Frame, Gpu, Imports, Record, RecordError};
use std::error::Error;
use tests::executors;

type TestResult = Result<(), Box<dyn Error>>;

static INTERFACE: Interface = Interface { groups: &[&["source"]], constants: &["X", "Y", "BITS_LOW", "BITS_HIGH"] };
static SHADER: Module<'static> = Module::new("poison.wgsl", include_str!("poison/poison.wgsl"));

const SIZE_PX: [u32; 2] = [64, 64];

/// Copies a texture and sets one texel to given bits in every channel.
#[derive(Clone, Copy, Debug)]
struct Poison {
    source: Texture,
    at: [i32; 2],
    bits: u32,
}

impl Pass for Poison {
    type Io = (View, Texture);

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Self::Io, DeclareError> {
        let desc = pass.desc(self.source)?;
        let source = pass.sampled(self.source)?;
        let into = pass.target(Target::New, "poisoned", TextureDesc::new(desc.extent, desc.format));
        Ok((source, pass.color(into, Intent::Overwrite)?))
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for Poison {
    fn record(&self, (source, _): &Self::Io, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        let [x, y] = self.at.map(f64::from);
        // Constants are f64, in which the payload of an f32 NaN would be lost, so the bits are passed in two halves.
        let constants = [x, y, f64::from(self.bits & 0xffff), f64::from(self.bits >> 16)];
        let provided = [Some(cx.view(*source)?.into())];
        let draw = FullScreen::new(ProgramDesc::new(&SHADER, &INTERFACE), &[]);
        FullScreen { constants: &constants, groups: &[&provided], ..draw }.draw(world.as_ref(), cx)
    }
}

/// Values for the texel: NaN, both infinities, a negative number, the largest half float, and a denormal.
const BAD: [(&str, u32); 6] = [
    ("NaN", 0x7fc0_0000),
    ("+Inf", 0x7f80_0000),
    ("-Inf", 0xff80_0000),
    ("-1", 0xbf80_0000),
    ("65504", 0x477f_e000),
    ("6e-8", 0x3380_0000),
];

/// An interface in the frame at which a texel is replaced.
struct Edge {
    /// True if the frame has temporal anti-aliasing, depth of field and bloom.
    lens: bool,
    /// Stage and its output.
    stage: &'static str,
    slot: Slot,
    /// Position of the texel.
    at: [i32; 2],
    /// Maximum distance of changed pixels from the texel, in pixels. `None` if bright pixels legitimately spread; then
    /// the number of pixels is bounded.
    reach: Option<i32>,
    /// Maximum number of NaN texels in later textures: those that the bad texel is drawn over or copied to.
    spoilt: usize,
}

const fn edge(lens: bool, stage: &'static str, slot: Slot, reach: Option<i32>, spoilt: usize) -> Edge {
    Edge { lens, stage, slot, at: [30, 40], reach, spoilt }
}

/// FXAA reads up to 7 pixels away, the upsampling of occlusion one more, and temporal anti-aliasing a 3×3 neighborhood.
const EDGES: [Edge; 8] = [
    edge(false, "occlusion", Slot::OCCLUSION, Some(9), 0),
    edge(false, "color", Slot::HDR, None, 1),
    edge(false, "transparent", Slot::HDR, Some(8), 1),
    edge(false, "post", Slot::PICTURE, Some(8), 0),
    edge(true, "transparent", Slot::HDR, None, 1),
    edge(true, "taa", Slot::HDR, None, 1),
    edge(true, "dof", Slot::HDR, None, 1),
    Edge { at: [15, 20], ..edge(true, "bloom", Slot::BLOOM, None, 1) },
];

/// Declares the standard frame with a copy after a stage; returns the picture's handle.
fn frame(
    settings: &Settings,
    stage: &str,
    slot: Slot,
    at: [i32; 2],
    bits: u32,
) -> Result<(Frame<World>, Texture), Box<dyn Error>> {
    let mut stages = stages(settings);
    let poison = Stage::new("poison", move |frame: &mut Frame<World>, handles: &mut Handles| {
        let poisoned = frame.add("poison", Poison { source: handles.get(slot)?, at, bits })?.1;
        handles.set(slot, poisoned);
        Ok(())
    });
    stages.insert_after(stage, poison)?;
    let mut frame = Frame::new();
    let output = frame
        .graph_mut()
        .texture("output", TextureDesc::new(framegraph::Extent::FRAME, framegraph::Format::Rgba8UnormSrgb));
    let handles = stages.declare(&mut frame, Handles::default(), Target::from(output))?;
    let picture = handles.get(Slot::PICTURE)?;
    frame.graph_mut().readback(picture)?;
    Ok((frame, picture))
}

/// Returns the number of NaN texels in every texture after the replaced one.
fn counted(gpu: &Gpu, set: &Set, shot: &Shot, frame: &Frame<World>) -> Result<Vec<(String, usize)>, Box<dyn Error>> {
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &shot.options, &mut Scratch::new(), &mut plan)?;
    let (mut executor, imports) = (executors::lend(gpu), Imports::new());
    executor.execute(&plan, frame, set.world(), &imports)?;
    let mut inspector = Inspector::new(gpu);
    let mut counts = Vec::new();
    for target in all_targets(&plan) {
        let found = inspector.inspect_target(&executor, &plan, frame, set.world(), &imports, target)?;
        counts.push((found.title(), found.texels.non_finite(found.texels.channels())));
    }
    Ok(counts)
}

#[test]
fn a_poisoned_pixel_stays_where_it_is() -> TestResult {
    let Some(gpu) = gpu("a_poisoned_pixel_stays_where_it_is") else { return Ok(()) };
    let plain =
        Settings { occlusion: Some(OcclusionSettings::sao(SaoQuality::Medium)), shadows: None, ..Settings::default() };
    let lens = Settings {
        taa: Some(TaaSettings::DEFAULT),
        dof: Some(DofSettings { f_number: 1.0, ..DofSettings::DEFAULT }),
        bloom: Some(BloomSettings::DEFAULT),
        ..plain
    };
    let size_px = SIZE_PX;
    let options = framegraph::Options::for_frame(size_px[0], size_px[1]);
    let shot = Shot { size_px, options, ..Shot::small(plain) };
    let set = Set::new(&gpu, "glass", &shot, &Background::Environment)?;
    let scene = Scene::open("glass", &mut progress::silent)?;
    for Edge { lens: with_lens, stage, slot, at, reach, spoilt } in test_report::share(EDGES) {
        let settings = if with_lens { lens } else { plain }.for_scene(&scene, size_px);
        assert!(settings.scene_levels > 3, "a pyramid in which a pixel could spread");
        let shoot = |at, bits| -> Result<Vec<u8>, Box<dyn Error>> {
            let (frame, picture) = frame(&settings, stage, slot, at, bits)?;
            Ok(set.render(&gpu, &frame, picture, &shot.options)?.0)
        };
        let clean = shoot([-1, -1], 0)?;
        let mut noticed = 0;
        for (name, bits) in BAD {
            let poisoned = shoot(at, bits)?;
            let differs = |pixel: &usize| poisoned[4 * pixel..4 * pixel + 4] != clean[4 * pixel..4 * pixel + 4];
            let changed: Vec<usize> = (0..clean.len() / 4).filter(differs).collect();
            noticed += usize::from(!changed.is_empty());
            let far = |pixel: &&usize| {
                let (x, y) = ((**pixel % 64) as i32 - at[0], (**pixel / 64) as i32 - at[1]);
                reach.is_some_and(|reach| x.abs().max(y.abs()) > reach)
            };
            assert_eq!(changed.iter().find(far), None, "{name} after {stage}: {} pixels", changed.len());
            // Light of 65504 is valid and appears blurred in glass; other values are dark.
            assert!(
                name == "65504" || name == "+Inf" || changed.len() < 500,
                "{name} after {stage}: {}",
                changed.len()
            );
        }
        assert!(noticed > 0, "nothing that is put behind {stage} is seen");
        let (frame, _) = frame(&settings, stage, slot, at, BAD[0].1)?;
        for (title, count) in counted(&gpu, &set, &shot, &frame)? {
            // The texel itself, in the replaced texture and in those drawn over it before grading.
            let own = ["poisoned", "hdr", "taa", "dof"].iter().any(|name| title.contains(name));
            let most = if own { spoilt.max(usize::from(title.contains("poisoned"))) } else { 0 };
            assert!(count <= most, "NaN after {stage}: {count} texels of {title}");
        }
    }
    Ok(())
}
