//! Whole frames in one block of memory under Vulkan's synchronization validation. Tested are the standard frame with depth, samples and histories, and frames of `cases/` with storage, buffers and copies, executed by mock recorders.

use crate::executed::{Staged, staged};
use crate::stage::gpu;
use framegraph::file::{GraphFile, Registry};
use framegraph::{Alias, Options, Placement, Plan, Scratch, Usage};
use framegraph_passes::effects::dof::DofSettings;
use framegraph_passes::gpu_scene::shadow_views::{ShadowFilter, ShadowSettings};
use framegraph_passes::{OcclusionSettings, ReflectionSettings, Settings, TaaSettings};
use framegraph_wgpu::{
    AdapterRequest, ExecuteError, Executor, ExecutorOptions, Frame, FrameLoop, Gpu, NotPlaced, Unsupported, Workers,
    mock,
};
use std::collections::BTreeSet;
use std::error::Error;
use std::process::Command;
use tests::stage::Stage;

type TestResult = Result<(), Box<dyn Error>>;

/// Small, since the validation layers also cost time per texel.
const SIZE_PX: [u32; 2] = [96, 54];

fn options(alias: Alias) -> Options {
    Options { alias, ..Options::default() }
}

/// Kinds of resources that all frames place.
#[derive(Debug, Default)]
struct Covered {
    depth: usize,
    samples: usize,
    storage: usize,
    copied: usize,
    buffers: usize,
}

impl Covered {
    fn add(&mut self, plan: &Plan) {
        for (resource, row) in plan.graph().resource_ids().zip(plan.resources()) {
            if !matches!(row.placement, Placement::Heap { .. }) {
                continue;
            }
            let texture = plan.graph().resources()[resource.index()].desc.texture();
            self.buffers += usize::from(texture.is_none());
            self.depth += usize::from(texture.is_some_and(|t| t.format.has_depth()));
            self.samples += usize::from(texture.is_some_and(|t| t.samples > 1));
            self.storage += usize::from(row.usage.contains(Usage::STORAGE));
            self.copied += usize::from(row.usage.contains(Usage::COPY_SOURCE));
        }
    }

    fn everything(&self) -> bool {
        [self.depth, self.samples, self.storage, self.copied, self.buffers].iter().all(|count| *count > 0)
    }
}

/// Returns settings with effects that use many textures, and two histories.
fn settings() -> Settings {
    let shadows = ShadowSettings { filter: ShadowFilter::Evsm, cascades: 2, ..ShadowSettings::texels(128) };
    Settings {
        samples: 4,
        prepass: true,
        shadows: Some(shadows),
        occlusion: Some(OcclusionSettings::default()),
        reflections: Some(ReflectionSettings::DEFAULT),
        dof: Some(DofSettings::DEFAULT),
        taa: Some(TaaSettings::DEFAULT),
        ..Settings::DEFAULT
    }
}

/// Variants of execution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Way {
    Apart,
    /// One block, recorded on three threads.
    Block,
    /// One block without alias barriers, as a negative control.
    Broken,
}

impl Way {
    const ALL: [Self; 3] = [Self::Apart, Self::Block, Self::Broken];

    fn alias(self) -> Alias {
        if self == Self::Apart { Alias::Off } else { Alias::Heap }
    }

    fn set(self, executor: &mut Executor) -> TestResult {
        match self {
            Self::Apart => {}
            Self::Block => executor.force_record_on(Workers::with_threads(3)?),
            Self::Broken => executor.skip_alias_barriers(),
        }
        Ok(())
    }
}

/// Draws the frame three times.
fn standard(gpu: &Gpu, way: Way, covered: &mut Covered) -> TestResult {
    let mut stage = Stage::new(gpu, "glass")?;
    let mut frames = FrameLoop::with(gpu, options(way.alias()), ExecutorOptions::default());
    way.set(frames.executor_mut())?;
    for number in 0..3 {
        stage.draw(&mut frames, &settings(), SIZE_PX, number)?;
    }
    covered.add(frames.plan());
    Ok(gpu.wait()?)
}

/// Textures and buffers that are copied, in memory that later resources reuse.
const COPIES: &str = r#"(version: 1,
    resources: [
        Texture(name: "screen", format: Rgba8UnormSrgb, kind: Import(entry: Undefined, exit: Keep)),
        Texture(name: "drawn", format: Rgba8Unorm),
        Texture(name: "copied", format: Rgba8Unorm),
        Texture(name: "light", format: Rgba16Float),
        Buffer(name: "counts", bytes: 4096),
        Buffer(name: "kept", bytes: 4096),
        Buffer(name: "sums", bytes: 2048),
    ],
    passes: [
        Raster(name: "draw", accesses: [Color(to: "drawn", intent: ClearColor(0, 0, 0, 1))]),
        Compute(name: "count", accesses: [Sampled(of: "drawn"), StorageWrite(to: "counts", intent: Overwrite)]),
        Copy(name: "copy", accesses: [CopySource(of: "drawn"), CopyTarget(to: "copied", intent: Overwrite)]),
        Copy(name: "keep", accesses: [CopySource(of: "counts"), CopyTarget(to: "kept", intent: Overwrite)]),
        Compute(name: "sum", accesses: [StorageRead(of: "kept"), StorageWrite(to: "sums", intent: Overwrite)]),
        Raster(name: "light", accesses: [Sampled(of: "copied"), StorageRead(of: "sums"), Color(to: "light", intent: Overwrite)]),
        Raster(name: "show", accesses: [Sampled(of: "light"), Color(to: "screen", intent: Overwrite)]),
    ],
)"#;

fn copies() -> Result<Staged, Box<dyn Error>> {
    let mut frame = Frame::new();
    frame.allow_threads();
    GraphFile::parse("copies.ron", COPIES)?.declare(&[], &Registry::new(), &mut frame)?;
    mock::add_recorders(&mut frame);
    Ok(Staged { label: "copies".to_owned(), frame, options: Options { frame: SIZE_PX, ..Options::default() } })
}

fn by_stand_ins(gpu: &Gpu, staged: &Staged, way: Way, covered: &mut Covered) -> TestResult {
    let (mut executor, mut plan) = (Executor::new(gpu), Plan::new());
    let options = Options { alias: way.alias(), ..staged.options };
    executor.compile(staged.frame.graph(), &options, &mut Scratch::new(), &mut plan)?;
    way.set(&mut executor)?;
    let imported = mock::imports(gpu, &plan)?;
    for _ in 0..3 {
        executor.execute(&plan, &staged.frame, &(), &imported.bound).map_err(|error| match error {
            ExecuteError::Unsupported(missing) => Box::<dyn Error>::from(missing),
            other => other.into(),
        })?;
    }
    covered.add(&plan);
    Ok(gpu.wait()?)
}

/// Runs in a process with the layers enabled; see `the_layers_are_silent_about_whole_frames`.
#[test]
#[ignore = "a part of another test, which sets its environment"]
fn frames_under_validation() -> TestResult {
    let asked = std::env::var("FRAMEGRAPH_WAY").unwrap_or_default();
    let way = Way::ALL.into_iter().find(|way| format!("{way:?}") == asked).ok_or("FRAMEGRAPH_WAY: no such way")?;
    // A new device for each frame, since these layers do not track host waits and report freed memory as in use.
    let open = || Gpu::open(&AdapterRequest::from_env());
    let (gpu, mut covered) = (open()?, Covered::default());
    let mut probe = Executor::new(&gpu);
    probe.compile(&framegraph::Graph::new(), &options(Alias::Heap), &mut Scratch::new(), &mut Plan::new())?;
    if let Some(why @ NotPlaced::Backend(_)) = probe.not_placed() {
        println!("ELSEWHERE {why}");
        return Ok(());
    }
    println!("FRAME standard");
    standard(&gpu, way, &mut covered)?;
    let (mut files, all) = (vec!["deferred.ron", "forward.ron"], staged());
    let asked = all.into_iter().filter(|staged| {
        let first = files.iter().position(|file| staged.label.starts_with(file));
        first.map(|at| files.remove(at)).is_some()
    });
    for staged in asked.chain([copies()?]) {
        println!("FRAME {}", staged.label);
        let gpu = open()?;
        // One frame draws four cascades at once; another test checks that the driver separates them.
        gpu.trust_attached_layers();
        match by_stand_ins(&gpu, &staged, way, &mut covered) {
            // Devices may lack some formats.
            Err(error) if error.is::<Unsupported>() => {}
            ran => ran?,
        }
    }
    assert!(way == Way::Apart || covered.everything(), "{covered:?}");
    println!("DONE {covered:?}");
    Ok(())
}

/// Returns the layers' messages for each frame, each kind once; an error if nothing was placed.
fn told(way: Way) -> Result<Result<BTreeSet<(String, String)>, String>, Box<dyn Error>> {
    let mut run = Command::new(std::env::current_exe()?);
    run.args(["--exact", "placed::frames_under_validation", "--ignored", "--nocapture"]);
    run.env("WGPU_VALIDATION", "1").env("FRAMEGRAPH_WAY", format!("{way:?}"));
    // Older layers compare command buffers with each other only if enabled.
    run.env("VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT");
    let out = run.output()?;
    let [said, errors] = [out.stdout, out.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    if let Some(why) = said.lines().find_map(|line| line.split_once("ELSEWHERE ")) {
        return Ok(Err(why.1.to_owned()));
    }
    assert!(said.contains("DONE"), "{said}\n{errors}");
    let (mut frame, mut messages) = ("", BTreeSet::new());
    for line in said.lines().chain(errors.lines()) {
        if let Some(name) = line.split_once("FRAME ") {
            frame = name.1;
        }
        if line.contains("Validation Error") {
            // The kinds of accesses in conflict, without handles and counts.
            let about = ["[ ", "recorded_usage: ", "command: ", "prior_usage: "].iter().filter_map(|mark| {
                let (_, rest) = line.split_once(mark)?;
                rest.split([',', ' ']).next()
            });
            let kind = about.collect::<Vec<_>>().join(" ");
            messages.insert((frame.to_owned(), kind));
        }
    }
    Ok(Ok(messages))
}

/// Frames in one block cause no messages that separate textures do not. wgpu stores read-only depth, which the layers
/// report as an unsynchronized write.
#[test]
fn the_layers_are_silent_about_whole_frames() -> TestResult {
    const NAME: &str = "the_layers_are_silent_about_whole_frames";
    if gpu(NAME).is_none() {
        return Ok(());
    }
    let (apart, block) = match (told(Way::Apart)?, told(Way::Block)?) {
        (Ok(apart), Ok(block)) => (apart, block),
        (Err(why), _) | (_, Err(why)) => {
            test_report::skip(NAME, &why);
            return Ok(());
        }
    };
    let more: Vec<_> = block.difference(&apart).collect();
    assert!(more.is_empty(), "{more:?}");
    // Without layers there are no messages, and newer layers do not compare memory of different images.
    let broken = told(Way::Broken)?.unwrap_or_default();
    let more: Vec<_> = broken.difference(&apart).filter(|(_, kind)| kind.contains("HAZARD")).collect();
    if more.is_empty() {
        test_report::skip(NAME, "the validation layers do not detect missing aliasing barriers");
        return Ok(());
    }
    let of_standard = more.iter().filter(|(frame, _)| frame == "standard").count();
    assert!(of_standard > 0 && of_standard < more.len(), "{more:?}");
    Ok(())
}
