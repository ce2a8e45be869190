//! Standard frame with a fog pass after its stage `color` and a sharpening filter instead of FXAA. See `README.md` in this
//! folder.

mod fog;
mod frame;
mod sharpen;

use frame::foggy;
use framegraph::{Extent, Format, Options, Plan, Scratch, Target, TextureDesc, compile, dump};
use framegraph_passes::gpu_scene::view::Background;
use framegraph_passes::light::ibl::cache::Cache;
use framegraph_passes::{CameraView, Handles, Lighting, Quality, Settings, Slot, ViewSettings, World};
use framegraph_scene::environment::Sky;
use framegraph_scene::picture::encode_png;
use framegraph_scene::{Scene, progress};
use framegraph_wgpu::{AdapterRequest, Executor, Frame, Gpu, Imports, OpenError, read_texture};
use program::interrupt;
use program::outputs::{OutputError, Outputs, is_special};
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;

const HELP: &str = "\
Renders the built-in scene `columns` at 640x360 with a fog pass after the color stage and a sharpening filter instead of FXAA.

usage: stages FILE.png [DENSITY]

  FILE.png   output file
  DENSITY    extinction of the fog in 1/m, 0 to 10 (0.05)

WGPU_BACKEND and WGPU_ADAPTER_NAME select another adapter.
Exit codes: 0 success, 1 device failure, 2 invalid input or output, 128 + N stopped by signal N.";

const SIZE_PX: [u32; 2] = [640, 360];

fn main() -> ExitCode {
    let args: Vec<String> = std::env::args_os().skip(1).map(|arg| arg.to_string_lossy().into_owned()).collect();
    if matches!(args.as_slice(), [one] if one == "--help" || one == "-h") {
        program::line(HELP);
        return program::exit(0);
    }
    let (out, density) = match arguments(&args) {
        Ok(asked) => asked,
        Err(message) => return fail(2, &message),
    };
    interrupt::exit_when_asked();
    match draw(Path::new(out), density) {
        Ok(()) => program::exit(0),
        Err(error) => {
            let user =
                error.is::<OutputError>() || matches!(error.downcast_ref(), Some(OpenError::UnknownBackend { .. }));
            fail(if user { 2 } else { 1 }, &error.to_string())
        }
    }
}

/// Parses the output file and the density.
fn arguments(args: &[String]) -> Result<(&str, f32), String> {
    let (out, density) = match args {
        [out] => (out, 0.05),
        [out, density] => match density.parse() {
            Ok(number) if (0.0..=10.0).contains(&number) => (out, number),
            _ => return Err(format!("DENSITY {density}: expected a number from 0 to 10")),
        },
        _ => return Err("FILE.png: missing argument; see `stages --help`".into()),
    };
    if Path::new(out).extension().is_none_or(|extension| extension != "png") && !is_special(Path::new(out)) {
        return Err(format!("{out}: the file must end in .png"));
    }
    Ok((out, density))
}

/// Prints one line on standard error and returns the exit code.
fn fail(code: u8, message: &str) -> ExitCode {
    program::error(message);
    program::exit(code)
}

fn draw(out: &Path, density: f32) -> Result<(), Box<dyn Error>> {
    let mut outputs = Outputs::default();
    outputs.add(out)?;
    let gpu = Gpu::open(&AdapterRequest::from_env())?;
    program::line(format_args!("adapter: {}", gpu.describe()));

    // Scene, light and view.
    let scene = Scene::open("columns", &mut progress::silent)?;
    let environment = Sky::default().environment(128)?;
    let quality = Quality::High;
    let lighting = Lighting::new(&gpu, &environment, &quality.light(), &Cache::from_env(), &mut progress::silent)?;
    let settings =
        Settings { samples: 4, shading: quality.shading(), ..Settings::default() }.for_scene(&scene, SIZE_PX);
    let seen = ViewSettings {
        camera: scene.default_camera(f64::from(SIZE_PX[0]) / f64::from(SIZE_PX[1])),
        size_px: SIZE_PX,
        shadows: settings.shadows,
        ..ViewSettings::default()
    };
    let view = CameraView::new(&scene, &lighting.image, &Background::Environment, &seen);
    let world = World::new(&gpu, &scene, lighting, [view], &mut progress::silent)?;

    // Declare, compile and execute the frame.
    let mut frame = Frame::<World>::new();
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba8UnormSrgb);
    let target = Target::from(frame.graph_mut().texture("output", desc));
    let picture = foggy(&settings, density)?.declare(&mut frame, Handles::default(), target)?.get(Slot::PICTURE)?;
    frame.graph_mut().readback(picture)?;
    let mut plan = Plan::new();
    let options = Options::for_frame(SIZE_PX[0], SIZE_PX[1]);
    compile(frame.graph(), &gpu.caps(), &options, &mut Scratch::new(), &mut plan)?;
    program::print(dump::text(&plan));
    let mut executor = Executor::new(&gpu);
    executor.execute(&plan, &frame, &world, &Imports::new())?;

    let texture = executor.texture(&plan, picture).ok_or("the frame has no picture")?;
    let picture = read_texture(&gpu, texture)?.rgba8();
    outputs.write(out, |file| encode_png(file, SIZE_PX, &picture))?;
    outputs.commit()?;
    program::line(format_args!("wrote {}", out.display()));
    Ok(())
}
