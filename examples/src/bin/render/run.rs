//! The run itself: device, graph, frames, files.

use crate::args::Args;
use crate::debug::report;
use crate::light::Around;
use crate::load;
use crate::table::table;
use framegraph::{Extent, Format, Options, Plan, Scratch, Target, Texture, TextureDesc, compile, dump};
use framegraph_passes::{CameraView, FrameIndex, FrameIo, Settings, StageError, World, standard};
use framegraph_scene::picture::{write_exr, write_png, write_text};
use framegraph_wgpu::Frame;
use framegraph_wgpu::{
    AdapterRequest, Executor, ExecutorOptions, Gpu, Imports, Pixels, StoreRounding, Timing, read_texture,
};
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Frames before the measured ones: shaders are compiled in the first.
pub const WARM_UP: u32 = Timing::WARM_UP;

/// Why nothing was rendered.
pub enum Failure {
    /// The user's input.
    Input(String),
    /// The device, or a fault of ours.
    Device(String),
}

pub fn input(error: impl Display) -> Failure {
    Failure::Input(error.to_string())
}

pub fn device(error: impl Display) -> Failure {
    Failure::Device(error.to_string())
}

/// Everything that frames are executed with, but plan and executor.
pub struct Prepared {
    pub gpu: Gpu,
    pub settings: Settings,
    pub frame: Frame<World>,
    pub io: FrameIo,
    pub world: World,
    /// Distance of the camera's near plane in meters.
    pub near_m: f32,
}

impl Prepared {
    /// What plans and executors are made with.
    pub fn options(&self, args: &Args) -> (Options, ExecutorOptions) {
        let [width, height] = args.size_px;
        let mut options = Options { inline: args.inline, ..Options::for_frame(width, height) };
        let mut execute = ExecutorOptions::default();
        args.debug.apply(&mut options, &mut execute);
        (options, execute)
    }
}

/// Loads what the command line names, opens the device, declares the frame, and uploads.
///
/// # Errors
/// One line, by whose fault it is.
pub fn prepare(args: &Args) -> Result<Prepared, Failure> {
    targets(args)?;
    let loaded = load::load(args).map_err(input)?;
    let seen = load::view(args, &loaded).map_err(input)?;
    let gpu = Gpu::open(&adapter()).map_err(device)?;
    println!("adapter: {}", gpu.describe());
    args.shading.precision.check(&gpu).map_err(|told| input(format!("--{told}")))?;
    let [width, height] = args.size_px;
    let most = gpu.caps().max_texture_texels;
    if width.max(height) > most {
        return Err(input(format!("--size {width}x{height}: the adapter's limit is {most}x{most}")));
    }
    let lighting = load::light(&gpu, args, &loaded).map_err(input)?;
    let moment = CameraView::new(&loaded.scene, &lighting.image, &loaded.background, &seen);
    let mut settings = settings(args, &loaded, &moment);
    if args.round_hdr {
        settings.stored = Some(StoreRounding::measure(&gpu).map_err(device)?);
    }
    let (frame, io) = declare(&settings, args.linear_out.is_some()).map_err(device)?;
    let near_m = seen.camera.projection.near_m() as f32;
    let world = load::upload(&gpu, &loaded, lighting, moment).map_err(input)?;
    Ok(Prepared { gpu, settings, frame, io, world, near_m })
}

/// Executes frames and waits for each.
///
/// # Errors
/// One line that names what the device refused.
pub fn render(
    prepared: &mut Prepared,
    plan: &Plan,
    executor: &mut Executor,
    frames: std::ops::Range<u32>,
) -> Result<(), Failure> {
    for index in frames {
        prepared.world.frame_index = FrameIndex(index);
        executor.execute(plan, &prepared.frame, &prepared.world, &Imports::new()).map_err(device)?;
        prepared.gpu.wait().map_err(device)?;
    }
    Ok(())
}

/// Renders what the command line asks for and writes the files.
///
/// # Errors
/// One line, by whose fault it is.
pub fn run(args: &Args) -> Result<(), Failure> {
    let mut prepared = prepare(args)?;
    let (options, execute) = prepared.options(args);
    let mut plan = Plan::new();
    let caps = prepared.gpu.caps();
    compile(prepared.frame.graph(), &caps, &options, &mut Scratch::new(), &mut plan).map_err(input)?;
    args.debug.wanted(&plan)?;

    let mut executor = Executor::with(&prepared.gpu, execute);
    render(&mut prepared, &plan, &mut executor, 0..WARM_UP)?;
    let before = executor.objects();
    render(&mut prepared, &plan, &mut executor, WARM_UP..WARM_UP + args.frames)?;
    executor.catch_up().map_err(device)?;
    print!("{}", table(&plan, executor.timing()));

    let Prepared { gpu, io, .. } = &prepared;
    let fetch = |handle: Texture| -> Result<Pixels, Failure> {
        let texture = executor.texture(&plan, handle).ok_or_else(|| device("the frame left no picture"))?;
        read_texture(gpu, texture).map_err(device)
    };
    write_png(&args.out, args.size_px, &fetch(io.output)?.rgba8()).map_err(input)?;
    if let Some(path) = &args.linear_out {
        write_exr(path, args.size_px, &fetch(io.hdr)?.rgba()).map_err(input)?;
    }
    write_text(&args.plan, &dump::text(&plan)).map_err(input)?;
    write_text(&args.dot, &dump::dot(&plan)).map_err(input)?;
    let files = [Some(&args.out), args.linear_out.as_ref(), Some(&args.plan), Some(&args.dot)];
    files.into_iter().flatten().for_each(|file| println!("wrote {}", file.display()));
    report(args, &prepared, &plan, &executor, before)
}

/// The folders that files go into must be there, and no file may be written over another or over what is read: better said
/// now than after the work.
fn targets(args: &Args) -> Result<(), Failure> {
    let files = [Some(&args.out), args.linear_out.as_ref(), Some(&args.plan), Some(&args.dot)];
    let files: Vec<&Path> = files.into_iter().flatten().map(PathBuf::as_path).chain(args.debug.files()).collect();
    let same = |a: &Path, b: &Path| a == b || a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b));
    let environment = match &args.lighting.around {
        Around::File(path) => Some(path.as_path()),
        _ => None,
    };
    for (index, file) in files.iter().copied().enumerate() {
        if [Some(Path::new(&args.scene)), environment].into_iter().flatten().any(|read| same(read, file)) {
            return Err(input(format!(
                "{}: it is read and would be written over; choose another name",
                file.display()
            )));
        }
        if files[..index].iter().any(|other| same(other, file)) {
            return Err(input(format!(
                "{}: two files would be written under this name; name them apart",
                file.display()
            )));
        }
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
            return Err(input(format!("{}: there is no folder {}", file.display(), folder.display())));
        }
    }
    if let Some(folder) = args.debug.folder().filter(|folder| !folder.is_dir()) {
        return Err(input(format!("--inspect-all: there is no folder {}", folder.display())));
    }
    Ok(())
}

/// The adapter to use: the best there is, unless the environment says otherwise.
pub fn adapter() -> AdapterRequest {
    AdapterRequest::from_env()
}

/// What the command line and the scene make of the standard frame.
pub fn settings(args: &Args, loaded: &load::Loaded, moment: &CameraView) -> Settings {
    let settings = Settings {
        samples: args.samples,
        shading: args.shading,
        shadows: moment.shadows.as_ref().map(|shadows| shadows.settings),
        fxaa: args.fxaa,
        split_post: args.split_post,
        post: args.post,
        ..Settings::default()
    };
    settings.for_scene(&loaded.scene, args.size_px)
}

/// The standard frame with its picture read back, and the linear radiance too if it is asked for.
pub fn declare(settings: &Settings, linear: bool) -> Result<(Frame<World>, FrameIo), StageError> {
    let mut frame = Frame::new();
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb);
    let output = frame.graph_mut().texture("output", desc);
    let io = standard(&mut frame, settings, Target::from(output))?;
    frame.graph_mut().readback(io.output);
    if linear {
        frame.graph_mut().readback(io.hdr);
    }
    Ok((frame, io))
}
