//! Every frame in `cases/` on a device: execution matches the plan under every debug mode.
//!
//! The passes have no shaders; mock recorders bind the declared resources and honor the declared accesses
//! (`framegraph_wgpu::mock`). Operations are counted at the wgpu calls, and objects at their creation.

use crate::cases::{cases_of, files};
use crate::stage::gpu;
use framegraph::file::{GraphFile, Registry};
use framegraph::{CompileErrors, Desc, Kind, Options, Placement, Plan, Scratch, TextureDesc, compile};
use framegraph_wgpu::debug::Mode;
use framegraph_wgpu::{Executor, ExecutorOptions, Gpu, read_texture};
use framegraph_wgpu::{Frame, mock};
use std::error::Error;

type TestResult = Result<(), Box<dyn Error>>;

/// A small, odd, non-square size.
const FRAME: [u32; 2] = [67, 38];
/// Smaller replacements for absolute sizes that are slow on a software driver; plans do not depend on them.
const SMALLER: [(&str, &str); 3] = [
    ("Texels(4096, 4096)", "Texels(96, 96)"),
    ("Texels(2048, 2048)", "Texels(80, 80)"),
    ("Texels(1024, 1024)", "Texels(64, 64)"),
];

/// A frame of a file with mock recorders, as a case requires.
pub struct Staged {
    pub label: String,
    pub frame: Frame,
    pub options: Options,
}

/// Returns every distinct frame of every file.
pub fn staged() -> Vec<Staged> {
    let mut all = Vec::new();
    for (path, text) in files() {
        let text = SMALLER.iter().fold(text, |text, (large, small)| text.replace(large, small));
        let file = GraphFile::parse(&path, &text).unwrap_or_else(|e| panic!("{e}"));
        let mut seen = Vec::new();
        for case in cases_of(&file) {
            let asked = (case.switches(), case.order, case.plain);
            if seen.contains(&asked) {
                continue;
            }
            let mut frame = Frame::new();
            file.declare(&asked.0, &Registry::new(), &mut frame).unwrap_or_else(|e| panic!("{e}"));
            mock::add_recorders(&mut frame);
            let mut options = Options { frame: FRAME, order: case.order, ..Options::default() };
            if case.plain {
                (options.merge, options.inline, options.memoryless) = (false, false, false);
            }
            all.push(Staged { label: format!("{path}, {}", case.label()), frame, options });
            seen.push(asked);
        }
    }
    all
}

/// Computes the number of pooled textures, history images and buffers of a plan from its placements alone.
///
/// A memoryless attachment lives in one step, so each shape needs as many textures as the busiest step.
fn objects(plan: &Plan) -> [u64; 3] {
    let (mut textures, mut histories, mut buffers) = (0, 0, 0);
    for slot in plan.slots() {
        *if slot.desc.texture().is_some() { &mut textures } else { &mut buffers } += 1;
    }
    let mut memoryless: Vec<(TextureDesc, framegraph::StepId)> = Vec::new();
    for (resource, row) in plan.graph().resource_ids().zip(plan.resources()) {
        let declared = plan.graph().resources()[resource.index()];
        match (row.placement, declared.kind, declared.desc) {
            (Placement::Own, Kind::Transient, Desc::Texture(_)) => textures += 1,
            (Placement::Own, Kind::Transient, Desc::Buffer(_)) => buffers += 1,
            (Placement::Own, Kind::HistoryCurrent { frames }, _) => histories += u64::from(frames) + 1,
            (Placement::Memoryless, _, Desc::Texture(desc)) => {
                // Only the size matters, not how it was declared.
                let [width, height] = desc.extent.texels(plan.frame());
                let format = plan.format(resource).unwrap_or(desc.format);
                let desc = desc.extent(framegraph::Extent::absolute(width, height)).format(format);
                memoryless.push((desc, row.first));
            }
            _ => {}
        }
    }
    let busiest = |shape: &TextureDesc| {
        let in_step = |step| memoryless.iter().filter(|(s, at)| s == shape && *at == step).count() as u64;
        plan.step_ids().map(in_step).max().unwrap_or(0)
    };
    let mut shapes: Vec<TextureDesc> = Vec::new();
    for (shape, _) in &memoryless {
        if !shapes.contains(shape) {
            shapes.push(*shape);
            textures += busiest(shape);
        }
    }
    [textures, histories, buffers]
}

/// Returns the plan, or the errors if the device does not support the frame.
fn planned(gpu: &Gpu, staged: &Staged, mode: Option<Mode>) -> Result<(Plan, ExecutorOptions), CompileErrors> {
    let (mut options, mut execute) = (staged.options, ExecutorOptions::default());
    mode.iter().for_each(|mode| mode.apply(&mut options, &mut execute));
    let mut plan = Plan::new();
    compile(staged.frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
    Ok((plan, execute))
}

/// Executes the frame three times and compares with the plan. A new executor's objects are counted too. Returns the
/// bytes of every picture that outlives the frame.
fn check(gpu: &Gpu, staged: &Staged, mode: Option<Mode>, by: &mut Executors) -> Result<Vec<Vec<u8>>, Box<dyn Error>> {
    let (plan, options) = planned(gpu, staged, mode)?;
    let imported = mock::imports(gpu, &plan)?;
    let (executor, fresh) = by.get(gpu, options);
    executor.reset_histories();
    // A history swaps two images, so the first two frames create views.
    let mut made = None;
    for frame in 0..3 {
        match executor.execute(&plan, &staged.frame, &(), &imported.bound) {
            Ok(_) => {}
            Err(error) => return Err(format!("{}, {mode:?}, frame {frame}: {error}", staged.label).into()),
        }
        assert_eq!(executor.executed(), plan.counts(), "{}, {mode:?}: executed against planned", staged.label);
        let of = executor.objects();
        let found = [of.textures, of.histories, of.buffers];
        assert!(!fresh || found == objects(&plan), "{}, {mode:?}: textures, images, buffers {found:?}", staged.label);
        let warm = if frame > 0 { *made.get_or_insert(of) } else { of };
        assert_eq!(of, warm, "{}, {mode:?}: a warm frame makes nothing", staged.label);
    }
    let readable = imported.textures.iter().filter(|(_, t)| t.sample_count() == 1);
    readable.map(|(_, texture)| Ok(read_texture(gpu, texture)?.bytes)).collect()
}

/// New executors for each frame, or one that caches pipelines.
enum Executors {
    Fresh(Option<Box<Executor>>),
    Kept(Vec<(ExecutorOptions, Executor)>),
}

impl Executors {
    fn get(&mut self, gpu: &Gpu, options: ExecutorOptions) -> (&mut Executor, bool) {
        match self {
            Self::Fresh(executor) => (&mut **executor.insert(Box::new(Executor::with(gpu, options))), true),
            Self::Kept(all) => {
                let at = all.iter().position(|(known, _)| *known == options).unwrap_or_else(|| {
                    all.push((options, Executor::with(gpu, options)));
                    all.len() - 1
                });
                (&mut all[at].1, false)
            }
        }
    }
}

const EVERY_MODE: [Option<Mode>; 7] = {
    let [a, b, c, d, e, f] = Mode::ALL;
    [None, Some(a), Some(b), Some(c), Some(d), Some(e), Some(f)]
};

/// On the noop device, formats without guaranteed storage support are missing, so the compiler refuses these frames. They are counted here, and executed by the next test.
#[test]
fn what_is_done_is_what_was_planned() -> TestResult {
    let gpu = Gpu::noop()?;
    let (mut frames, mut beyond) = (0, 0);
    for staged in staged() {
        for mode in EVERY_MODE {
            match check(&gpu, &staged, mode, &mut Executors::Fresh(None)) {
                Ok(_) => frames += 1,
                Err(error) if error.is::<CompileErrors>() => beyond += 1,
                Err(error) => return Err(error),
            }
        }
    }
    println!("{frames} frames were executed as planned, {beyond} ask for more than the device has");
    assert!(frames > 100 && beyond * 4 < frames, "{frames} executed, {beyond} beyond the device");
    Ok(())
}

/// On a real driver, execution matches the plan, and every mode leaves the same bits. Inlined frames are not compared,
/// since mock recorders ignore epilogues.
#[test]
fn no_mode_changes_what_a_frame_leaves_behind() -> TestResult {
    let Some(gpu) = gpu("no_mode_changes_what_a_frame_leaves_behind") else { return Ok(()) };
    // One frame draws four cascades at once; another test checks that the driver separates them.
    gpu.trust_attached_layers();
    let mut executors = Executors::Kept(Vec::new());
    let (mut compared, mut plain) = (0, 0);
    for staged in test_report::share(staged()) {
        check(&gpu, &staged, None, &mut executors)?;
        let apart = Staged { options: Options { inline: false, ..staged.options }, ..staged };
        let mut expected = None;
        for mode in EVERY_MODE.into_iter().filter(|m| *m != Some(Mode::NoInline)) {
            let left = check(&gpu, &apart, mode, &mut executors)?;
            plain += left.iter().filter(|bytes| bytes.chunks_exact(4).all(|t| t == &bytes[..4])).count();
            let same = *expected.get_or_insert_with(|| left.clone()) == left;
            assert!(same, "{}, {mode:?}: another picture", apart.label);
            compared += left.len();
        }
    }
    println!("{compared} pictures were compared");
    assert!(compared > 30 && plain * 4 < compared, "{compared} pictures, {plain} of them of one color");
    Ok(())
}
