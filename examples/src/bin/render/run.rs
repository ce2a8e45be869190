//! The run itself: device, graph, frames, files.

use crate::args::Args;
use crate::load;
use crate::table::table;
use framegraph::{Extent, Format, Options, Plan, Scratch, Target, Texture, TextureDesc, compile, dump};
use passes::{Settings, View, World, standard, view};
use renderer::Frame;
use renderer::picture::{write_exr, write_png, write_text};
use renderer::scene::AlphaMode;
use renderer::wgpu::{AdapterRequest, Executor, Gpu, Imports, Pixels, StoreRounding, read_texture};
use std::fmt::Display;

/// Frames before the measured ones: shaders are compiled in the first.
const WARM_UP: u32 = 3;

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

/// Renders what the command line asks for and writes the files.
///
/// # Errors
/// One line, by whose fault it is.
pub fn run(args: &Args) -> Result<(), Failure> {
    targets(args)?;
    let loaded = load::load(args).map_err(input)?;
    let seen = load::view(args, &loaded).map_err(input)?;
    let gpu = Gpu::open(&adapter()).map_err(device)?;
    println!("adapter: {}", gpu.describe());
    let caps = gpu.caps();
    let [width, height] = args.size_px;
    if width.max(height) > caps.max_texture_texels {
        let most = caps.max_texture_texels;
        return Err(input(format!("--size {width}x{height}: the adapter's limit is {most}x{most}")));
    }

    let sh = view::ambient(&loaded.environment);
    let moment = View::new(&loaded.scene, &loaded.environment, &sh, &loaded.background, &seen);
    let mut settings = settings(args, &loaded, &moment);
    if args.round_hdr {
        settings.stored = Some(StoreRounding::measure(&gpu).map_err(device)?);
    }
    let (frame, io) = declare(&settings, args.linear_out.is_some()).map_err(device)?;
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    let options = Options { inline: args.inline, ..Options::for_frame(width, height) };
    compile(frame.graph(), &caps, &options, &mut scratch, &mut plan).map_err(input)?;

    let mut world = load::upload(&gpu, &loaded, moment).map_err(input)?;
    let mut executor = Executor::new(&gpu);
    for index in 0..WARM_UP + args.frames {
        world.view.frame.frame_index = index;
        executor.execute(&plan, &frame, &world, &Imports::new()).map_err(device)?;
        gpu.wait().map_err(device)?;
    }
    executor.catch_up().map_err(device)?;
    print!("{}", table(&plan, executor.timing()));

    let fetch = |handle: Texture| -> Result<Pixels, Failure> {
        let texture = executor.texture(&plan, handle).ok_or_else(|| device("the frame left no picture"))?;
        read_texture(&gpu, texture).map_err(device)
    };
    write_png(&args.out, args.size_px, &fetch(io.output)?.rgba8()).map_err(input)?;
    if let Some(path) = &args.linear_out {
        write_exr(path, args.size_px, &fetch(io.hdr)?.rgba()).map_err(input)?;
    }
    write_text(&args.plan, &dump::text(&plan)).map_err(input)?;
    write_text(&args.dot, &dump::dot(&plan)).map_err(input)?;
    let files = [Some(&args.out), args.linear_out.as_ref(), Some(&args.plan), Some(&args.dot)];
    files.into_iter().flatten().for_each(|file| println!("wrote {}", file.display()));
    Ok(())
}

/// The folders that files go into must be there: better said now than after the work.
fn targets(args: &Args) -> Result<(), Failure> {
    let files = [Some(&args.out), args.linear_out.as_ref(), Some(&args.plan), Some(&args.dot)];
    for file in files.into_iter().flatten() {
        let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
            return Err(input(format!("{}: there is no folder {}", file.display(), folder.display())));
        }
    }
    Ok(())
}

/// The adapter to use: the best there is, unless the environment says otherwise.
pub fn adapter() -> AdapterRequest {
    AdapterRequest::from_env()
}

/// What the command line and the scene make of the standard frame.
pub fn settings(args: &Args, loaded: &load::Loaded, moment: &View) -> Settings {
    let has_sun = moment.frame.sun_illuminance != glam::Vec3::ZERO;
    let settings = Settings {
        samples: args.samples,
        shadows: args.shadows && has_sun,
        fxaa: args.fxaa,
        blended: loaded.scene.materials.iter().any(|m| m.alpha == AlphaMode::Blend),
        split_post: args.split_post,
        ..Settings::default()
    };
    settings.with_look(args.look)
}

/// The standard frame with its picture read back, and the linear radiance too if it is asked for.
pub fn declare(settings: &Settings, linear: bool) -> Result<(Frame<World>, passes::FrameIo), framegraph::DeclareError> {
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
