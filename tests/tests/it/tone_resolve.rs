//! Tone-mapped resolve: the shader compared with its formula, and the stores of a frame with it.

use crate::stage::{gpu, plan};
use framegraph::{
    Caps, DeclareError, Extent, Format, Intent, Options, Pass, PassBuilder, Plan, Scratch, Texture, TextureDesc,
    compile,
};
use framegraph_passes::effects::post::tone_resolve::ToneResolve;
use framegraph_passes::program::full_screen::FullScreen;
use framegraph_passes::program::{Interface, ProgramDesc, Programs};
use framegraph_passes::{BloomSettings, Settings};
use framegraph_shader_mirrors::bloom::firefly_weight;
use framegraph_shaders::Module;
use framegraph_wgpu::{Cx, Frame, Imports, Record, RecordError, read_texture};
use glam::DVec3;
use std::error::Error;
use tests::executors;

type TestResult = Result<(), Box<dyn Error>>;

static NOTHING: Interface = Interface { groups: &[], constants: &[] };
static SHADER: Module<'static> = Module::new("samples.wgsl", include_str!("tone_resolve/samples.wgsl"));

/// Draws four samples of different radiance.
#[derive(Clone, Copy, Debug)]
struct Samples;

impl Pass for Samples {
    type Io = Texture;

    fn declare(&self, pass: &mut PassBuilder<'_>) -> Result<Texture, DeclareError> {
        let samples = pass.texture("hdr_samples", TextureDesc::new(Extent::FRAME, Format::Rgba16Float).samples(4));
        pass.color(samples, Intent::Overwrite)
    }
}

impl<W: AsRef<Programs> + ?Sized> Record<W> for Samples {
    fn record(&self, _: &Texture, world: &W, cx: &mut Cx<'_>) -> Result<(), RecordError> {
        FullScreen::new(ProgramDesc::new(&SHADER, &NOTHING), &[]).draw(world.as_ref(), cx)
    }
}

/// Radiance as in the shader: dim, except for one sample in some texels that is bright or beyond the range of half
/// floats.
fn sample(x: u32, sample: u32) -> DVec3 {
    match (x, sample) {
        (1, 2) => DVec3::new(300.0, 20.0, 4.0),
        (2, 0) => DVec3::splat(65504.0),
        (3, _) => DVec3::new(0.0, 0.0, 7.0),
        _ => DVec3::new(0.25, 0.5, 0.125) * f64::from(1 + sample),
    }
}

#[test]
fn a_bright_sample_does_not_rule_its_texel() -> TestResult {
    let Some(gpu) = gpu("a_bright_sample_does_not_rule_its_texel") else { return Ok(()) };
    let mut frame = Frame::<Programs>::new();
    let samples = frame.add("samples", Samples)?;
    let hdr = frame.add("resolve", ToneResolve { samples })?.hdr;
    frame.graph_mut().readback(hdr)?;
    let mut plan = Plan::new();
    compile(frame.graph(), &gpu.caps(), &Options::for_frame(5, 3), &mut Scratch::new(), &mut plan)?;
    let mut executor = executors::lend(&gpu);
    executor.execute(&plan, &frame, &Programs::new(), &Imports::new())?;
    let found = read_texture(&gpu, executor.texture(&plan, hdr).ok_or("there is no picture")?)?.rgba();
    for (at, found) in found.iter().enumerate() {
        let colors = [0, 1, 2, 3].map(|s| sample(at as u32 % 5, s));
        let whole: f64 = colors.iter().map(|c| firefly_weight(*c)).sum();
        let expected = colors.iter().map(|c| *c * firefly_weight(*c)).sum::<DVec3>() / whole;
        // Alpha is averaged with equal weights.
        assert_eq!(found[3], [2.5, 2.0, 2.5, 1.0, 2.5][at % 5], "texel {at}");
        let found = DVec3::from_array([0, 1, 2].map(|c: usize| found[c].into()));
        // Half floats have eleven bits.
        let off = (found - expected).abs().max_element() / expected.max_element();
        assert!(off < 1e-3, "texel {at}: {found} for {expected}");
        let mean = colors.iter().sum::<DVec3>() / 4.0;
        assert!(!matches!(at % 5, 1 | 2) || mean.x > 20.0 * found.x, "texel {at} is ruled by one sample");
    }
    Ok(())
}

/// Samples that a pass reads are stored, and the device's resolve is not used.
#[test]
fn a_resolve_by_a_pass_takes_the_place_of_the_devices() {
    let counts = |samples, tone_resolve, bloom: bool| {
        let bloom = bloom.then_some(BloomSettings::DEFAULT);
        let settings = Settings { samples, tone_resolve, bloom, ..Settings::DEFAULT };
        let plan = plan(&settings, &Caps::wgpu(), &Options::for_frame(1280, 720));
        let names: Vec<_> = plan.graph().pass_ids().map(|pass| plan.graph().pass_name(pass).to_owned()).collect();
        (plan.counts(), plan.traffic([1280, 720]), names.contains(&"tone_resolve".to_owned()))
    };
    let (devices, devices_bytes, _) = counts(4, false, true);
    let (own, own_bytes, declared) = counts(4, true, true);
    assert!(declared);
    // Samples and resolved picture are stored, instead of the resolved picture alone.
    assert_eq!((own.passes, own.steps, own.resolves), (devices.passes + 1, devices.steps + 1, devices.resolves + 1));
    assert_eq!((own.multisample_resolves, own.unresolves), (devices.multisample_resolves - 1, devices.unresolves));
    // Half floats of four channels: four samples per pixel are stored and loaded, and the resolved picture is stored as
    // before.
    let texels = 1280 * 720;
    assert_eq!(own_bytes.stored_bytes - devices_bytes.stored_bytes, 4 * 8 * texels);
    assert_eq!(devices_bytes.multisample_resolve_bytes - own_bytes.multisample_resolve_bytes, 8 * texels);
    assert_eq!(counts(1, true, true), counts(1, false, true), "a frame of one sample has nothing to average");
}
