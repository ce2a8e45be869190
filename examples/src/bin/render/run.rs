//! A run: device, graph, frames and output files.

use crate::args::Args;
use crate::budget;
use crate::debug::report;
use crate::decide::FeatureCulling;
use crate::dirt::Dirt;
use crate::effect_costs;
use crate::kept_shadows::{Kept, OwnResources, declare, first_frame};
use crate::latency;
use crate::light::EnvironmentSource;
use crate::load::{self, Loaded};
use crate::pick;
use crate::sequence;
use crate::table::{facts_table, memory, table};
use crate::what_if;
use framegraph::file::to_ron;
use framegraph::{Options, Plan, Scratch, Texture, dump};
use framegraph_passes::effects::exposure::Measurement;
use framegraph_passes::feature_culling::savings;
use framegraph_passes::gpu_scene::punctual::LightLists;
use framegraph_passes::gpu_scene::upload::block_formats;
use framegraph_passes::gpu_scene::view::ViewSettings;
use framegraph_passes::{CameraView, Facts, FrameIndex, FrameIo, Settings, ViewId, World};
use framegraph_scene::BlockFormats;
use framegraph_scene::picture::{encode_exr, encode_png};
use framegraph_wgpu::{
    AdapterRequest, ExecuteError, Executor, ExecutorOptions, Frame, Gpu, Imports, OpenError, Pixels, RecordError,
    StoreRounding, Timing, Workers, read_texture,
};
use program::interrupt;
use program::outputs::{Outputs, check_folder};
use program::progress::Shown;
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Number of warm-up frames; the first one compiles shaders.
pub const WARM_UP: u32 = Timing::WARM_UP;

/// Reason that nothing was rendered.
pub enum Failure {
    /// Invalid input.
    Input(String),
    /// Device failure or internal error.
    Device(String),
}

pub fn input(error: impl Display) -> Failure {
    Failure::Input(error.to_string())
}

pub fn device(error: impl Display) -> Failure {
    Failure::Device(error.to_string())
}

/// State for executing frames, except the plan and the executor.
pub struct Prepared {
    pub gpu: Gpu,
    pub settings: Settings,
    pub frame: Frame<World>,
    pub io: FrameIo,
    pub world: World,
    /// Imported resources of the frame.
    pub imports: Imports,
    /// Kept shadow maps with `--shadow keep=on`.
    pub kept: Option<Kept>,
    /// Lens dirt with `--dirt`.
    pub dirt: Option<Dirt>,
    /// Distance of the camera's near plane in meters.
    pub near_m: f32,
    /// Requested settings; `settings` excludes dropped effects.
    pub asked: Settings,
    /// Decisions of feature culling.
    pub facts: Facts,
    /// Inputs of feature culling.
    pub culling: FeatureCulling,
    /// The scene without its images.
    pub loaded: Loaded,
    /// View settings with the requested shadows.
    pub seen: ViewSettings,
}

impl Prepared {
    /// Returns the options for compiling plans and creating executors.
    pub fn options(&self, args: &Args) -> (Options, ExecutorOptions) {
        let [width, height] = args.size_px;
        let mut options = Options { inline: args.frame.inline, alias: args.alias, ..Options::for_frame(width, height) };
        let mut execute = ExecutorOptions { timing: true, ..ExecutorOptions::default() };
        args.debug.apply(&mut options, &mut execute);
        (options, execute)
    }

    /// Creates an executor with these options and the number of threads of the command line.
    ///
    /// # Errors
    /// The system cannot create a thread.
    pub fn executor(&self, args: &Args, options: ExecutorOptions) -> Result<Executor, Failure> {
        let workers = if args.threads == 0 { Workers::new() } else { Workers::with_threads(args.threads) };
        let mut executor = Executor::with(&self.gpu, options);
        executor.record_on(Some(workers.map_err(device)?));
        Ok(executor)
    }
}

/// Opens the device, loads the scene, declares the frame, and uploads.
///
/// # Errors
/// An input or device failure with a one-line message. An output file must not be an input file of the scene.
pub fn prepare(args: &Args, outputs: &mut Outputs) -> Result<Prepared, Failure> {
    // Images are decoded to formats that the device samples. Invalid input is reported even without a device.
    let gpu = open();
    let options = args.load_options(gpu.as_ref().map_or(BlockFormats::default(), block_formats));
    let mut loaded = load::load(args, &options).map_err(input)?;
    args.animation.apply(&mut loaded.scene, 0.0).map_err(input)?;
    for file in &loaded.scene.files {
        outputs.reads(file).map_err(input)?;
    }
    for file in args.grade.color_table.iter().chain(&args.settings).chain(&args.effects.dirt) {
        outputs.reads(file).map_err(input)?;
    }
    let colors = load::colors(args).map_err(input)?;
    let seen = load::view(args, &loaded).map_err(input)?;
    let gpu = gpu?;
    if !args.trial {
        program::line(format_args!("adapter: {}", gpu.describe()));
    }
    args.frame.settings.shading.precision.check(&gpu).map_err(|error| input(format!("--{error}")))?;
    let [width, height] = args.size_px;
    let max = gpu.caps().max_texture_texels;
    if width.max(height) > max {
        return Err(input(format!("--size {width}x{height}: exceeds the adapter's limit of {max}x{max}")));
    }
    let lighting = load::light(&gpu, args, &loaded).map_err(input)?;
    let mut asked = settings(args, &loaded, &seen);
    if args.round_hdr {
        asked.stored = Some(StoreRounding::measure(&gpu).map_err(device)?);
    }
    let mut culling = FeatureCulling::new(&args.decide, &loaded, &asked);
    let facts = culling.facts(&loaded, &lighting.image, &seen, &asked, Measurement::Off);
    let settings = facts.apply(&asked);
    let shown = ViewSettings { shadows: settings.shadows, ..seen.clone() };
    let moment = CameraView::new(&loaded.scene, &lighting.image, &loaded.background, &shown);
    if !loaded.scene.lights.is_empty() && !args.trial {
        program::line(format_args!("lights: {}", moment.light_report));
    }
    if moment.light_lists.is_some() && !LightLists::can_be_bound(&gpu.device.limits()) {
        program::note(format_args!(
            "the adapter has too few storage buffer bindings for light lists; shading loops over all lights"
        ));
    }
    let mut kept = moment.shadows.as_ref().filter(|_| args.shadows.keep).map(|_| Kept::default());
    if asked.bloom.is_none() && args.effects.dirt.is_some() {
        return Err(input("--dirt: requires bloom; add --bloom on"));
    }
    let dirt = args.effects.dirt.as_deref().map(|file| Dirt::load(&gpu, file, &options.memory)).transpose()?;
    let kept_shadows = kept.as_mut().zip(moment.shadows.as_ref()).map(|(kept, shadows)| (&gpu, kept, shadows));
    let own = OwnResources { kept: kept_shadows, dirt: dirt.as_ref() };
    let (frame, io, imports) = declare(&settings, &facts, args.linear_out.is_some(), own)?;
    let near_m = seen.camera.projection.near_m() as f32;
    let mut world = load::upload(&gpu, &mut loaded, &options, lighting, moment)?;
    world.grading.set_colors(colors);
    let mut prepared =
        Prepared { gpu, settings, frame, io, world, imports, kept, dirt, near_m, asked, facts, culling, loaded, seen };
    first_frame(args, &mut prepared)?;
    Ok(prepared)
}

/// Opens the best adapter, or the one that environment variables select.
///
/// # Errors
/// An invalid environment variable is an input failure, everything else a device failure.
pub fn open() -> Result<Gpu, Failure> {
    Gpu::open(&AdapterRequest::from_env()).map_err(|error| match error {
        OpenError::UnknownBackend { .. } => input(error),
        _ => device(error),
    })
}

/// Classifies an execution error as an input or a device failure.
pub fn executed(error: ExecuteError) -> Failure {
    match error {
        ExecuteError::Record { error: RecordError::Content(_), .. } => input(error),
        _ => device(error),
    }
}

/// Executes frames, waits for each and shows the progress.
///
/// # Errors
/// One line with the error of the device, or a signal.
pub fn render(
    prepared: &mut Prepared,
    plan: &Plan,
    executor: &mut Executor,
    frames: std::ops::Range<u32>,
    shown: &mut Frames,
) -> Result<(), Failure> {
    for index in frames {
        prepared.world.frame_index = FrameIndex(index);
        if let Some(taa) = &prepared.settings.taa {
            prepared.world.views.again(ViewId::MAIN, taa.jitter_px(index)).map_err(device)?;
        }
        executor.execute(plan, &prepared.frame, &prepared.world, &prepared.imports).map_err(executed)?;
        prepared.gpu.wait().map_err(device)?;
        shown.next()?;
    }
    Ok(())
}

/// Progress of rendered frames.
pub struct Frames {
    shown: Shown,
    done: usize,
    total: usize,
}

impl Frames {
    pub fn new(total: u32) -> Self {
        Self { shown: Shown::default(), done: 0, total: total as usize }
    }

    /// Counts one more rendered frame.
    ///
    /// # Errors
    /// A signal arrived.
    pub fn next(&mut self) -> Result<(), Failure> {
        self.done += 1;
        self.shown.step("rendering frames", self.done, self.total, "");
        if self.done == self.total {
            self.shown.clear();
        }
        interrupt::check().map_err(device)
    }
}

/// Renders the frame of the command line and writes the files.
///
/// # Errors
/// An input or device failure with a one-line message.
pub fn run(args: &Args) -> Result<(), Failure> {
    let mut outputs = outputs(args)?;
    pick::check(args).map_err(input)?;
    let what_if = args.decide.what_if.as_deref().map(what_if::device).transpose()?;
    let chosen = args.budget.bound.map(|bound| budget::choose(args, bound)).transpose()?;
    let args = chosen.as_ref().unwrap_or(args);
    let mut prepared = prepare(args, &mut outputs)?;
    if let Some(asked) = &args.decide.sequence {
        sequence::render(args, &mut prepared, asked, &mut outputs)?;
        return written(outputs, &[]);
    }
    let (options, execute) = prepared.options(args);
    let mut plan = Plan::new();
    let mut executor = prepared.executor(args, execute)?;
    executor.compile(prepared.frame.graph(), &options, &mut Scratch::new(), &mut plan).map_err(input)?;
    let caps = prepared.gpu.caps();
    let inspections = args.debug.wanted(&plan)?;
    for (path, _) in &inspections {
        outputs.add(path).map_err(input)?;
    }

    let mut shown = Frames::new(WARM_UP + args.frames);
    render(&mut prepared, &plan, &mut executor, 0..WARM_UP, &mut shown)?;
    let before = executor.objects();
    render(&mut prepared, &plan, &mut executor, WARM_UP..WARM_UP + args.frames, &mut shown)?;
    executor.catch_up().map_err(device)?;
    program::print(table(&plan, executor.timing()));
    program::print(memory(&plan, &executor));
    let mut saved = savings::<World>(&prepared.facts, &prepared.asked, &caps, &options).map_err(device)?;
    program::print(facts_table(&prepared.facts, &saved));
    if let Some(caps) = &what_if {
        program::print(what_if::table(caps, prepared.frame.graph(), &options, &plan)?);
    }

    let Prepared { gpu, io, .. } = &prepared;
    let fetch = |handle: Texture| -> Result<Pixels, Failure> {
        let texture = executor.texture(&plan, handle).ok_or_else(|| device("the frame has no picture"))?;
        read_texture(gpu, texture).map_err(device)
    };
    let picture = fetch(io.output)?.rgba8();
    outputs.write(&args.out, |file| encode_png(file, args.size_px, &picture)).map_err(input)?;
    if let Some(path) = &args.linear_out {
        let light = fetch(io.hdr)?.rgba();
        let drawn_px = prepared.settings.drawn_px(args.size_px);
        outputs.write(path, |file| encode_exr(file, drawn_px, &light)).map_err(input)?;
    }
    for (path, text) in [(&args.plan, dump::text as fn(&Plan) -> String), (&args.dot, dump::dot)] {
        if let Some(path) = path {
            outputs.write(path, |file| file.write_all(text(&plan).as_bytes())).map_err(input)?;
        }
    }
    if let Some(path) = &args.decide.graph {
        let text = to_ron(prepared.frame.graph(), &args.scene, args.size_px);
        outputs.write(path, |file| file.write_all(text.as_bytes())).map_err(input)?;
    }
    let notes = report(args, &mut prepared, &plan, &executor, before, &inspections, &mut outputs)?;
    if args.debug.timing {
        program::print(latency::table(args, &mut prepared, &plan, &mut executor)?);
    }
    if args.decide.effect_costs {
        saved = effect_costs::measure(args, &mut prepared)?;
        program::print(effect_costs::table(&prepared, &saved));
    }
    for line in pick::lines(args, &prepared)? {
        program::line(line);
    }
    if let Some(path) = &args.decide.json {
        outputs.write(path, |file| file.write_all(prepared.facts.json(&saved).as_bytes())).map_err(input)?;
    }
    written(outputs, &notes)
}

/// Renames the files into place and lists them.
fn written(outputs: Outputs, notes: &[(PathBuf, String)]) -> Result<(), Failure> {
    interrupt::check().map_err(device)?;
    for path in outputs.commit().map_err(input)? {
        let about = notes.iter().find(|(of, _)| *of == path).map_or("", |(_, about)| about.as_str());
        program::line(format_args!("wrote {}{about}", path.display()));
    }
    Ok(())
}

/// Registers the output files that are known before loading, so that unwritable paths are reported before the work.
fn outputs(args: &Args) -> Result<Outputs, Failure> {
    let mut outputs = Outputs::default();
    outputs.reads(Path::new(&args.scene)).map_err(input)?;
    if let EnvironmentSource::File(environment) = &args.lighting.environment {
        outputs.reads(environment).map_err(input)?;
    }
    for file in args.settings.iter().chain(&args.budget.record) {
        outputs.reads(file).map_err(input)?;
    }
    if let Some(file) = args.decide.what_if.as_ref().filter(|which| which.ends_with(".ron")) {
        outputs.reads(Path::new(file)).map_err(input)?;
    }
    if let Some(sequence) = &args.decide.sequence {
        let option = if sequence.turns { "turntable" } else { "sequence" };
        check_folder(&sequence.folder).map_err(|error| input(format!("--{option}: {error}")))?;
        for file in sequence::files(sequence) {
            outputs.add(&file).map_err(input)?;
        }
        return Ok(outputs);
    }
    let own = [args.decide.json.as_ref(), args.decide.graph.as_ref()];
    let files = [Some(&args.out), args.linear_out.as_ref(), args.plan.as_ref(), args.dot.as_ref()];
    let files = files.into_iter().chain(own);
    for file in files.flatten().map(PathBuf::as_path).chain(args.debug.files()) {
        outputs.add(file).map_err(input)?;
    }
    if let Some(folder) = args.debug.folder() {
        check_folder(folder).map_err(|error| input(format!("--inspect-all: {error}")))?;
    }
    Ok(outputs)
}

/// Returns the standard frame settings of the command line and the scene, before feature culling.
pub fn settings(args: &Args, loaded: &Loaded, seen: &ViewSettings) -> Settings {
    let settings = Settings { shadows: seen.shadows, ..args.frame.settings };
    args.decide.of(settings).for_scene(&loaded.scene, args.frame.settings.drawn_px(args.size_px))
}
