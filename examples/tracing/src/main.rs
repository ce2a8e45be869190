//! Writes a trace of a few frames: `cargo run -p tracing_example -- trace.json`. Open the file in
//! <https://ui.perfetto.dev>.

use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, TextureDesc};
use framegraph_wgpu::{Frame, FrameLoop, Gpu};
use program::cli::{self, Parsed};
use program::outputs::Outputs;
use std::error::Error;
use std::path::Path;
use std::process::ExitCode;
use tracing_example::ChromeTrace;

fn main() -> ExitCode {
    let file = cli::argument("FILE", "file to write, for example trace.json").required(true);
    let command = cli::command("traced_frames", "Writes a trace of ten frames for Perfetto and Chrome.", "").arg(file);
    match cli::parse(command, std::env::args_os().skip(1)) {
        Ok(Parsed::Help(text)) => {
            program::print(text);
            program::exit(0)
        }
        Ok(Parsed::Given(given)) => {
            program::ended("traced_frames", given.values("FILE").try_for_each(|path| run(Path::new(path))))
        }
        Err(error) => {
            program::note(format_args!("traced_frames: {error}"));
            program::exit(2)
        }
    }
}

fn run(path: &Path) -> Result<(), Box<dyn Error>> {
    let trace = ChromeTrace::default();
    tracing::subscriber::set_global_default(trace.clone())?;
    let mut frames = FrameLoop::<()>::new(&Gpu::noop()?);
    for _ in 0..10 {
        frames.run([640, 360], &(), |frame, _| declare(frame))?;
    }
    Outputs::one(path, trace.json().to_string().as_bytes())?;
    program::line(format_args!("{} has the spans of 10 frames", path.display()));
    Ok(())
}

/// Declares two passes that are merged, and one that samples their picture.
fn declare(frame: &mut Frame) -> Result<(), DeclareError> {
    let desc = TextureDesc::new(Extent::FRAME, Format::Rgba16Float);
    let [scene, picture] = ["scene", "picture"].map(|name| frame.graph_mut().texture(name, desc));
    let scene = frame.add_fn("sky", |p| p.color(scene, Intent::Clear(ClearValue::BLACK)), |_, _, _| Ok(()))?;
    let scene = frame.add_fn("objects", |p| p.color(scene, Intent::Modify), |_, _, _| Ok(()))?;
    let picture = frame.add_fn(
        "grade",
        |p| {
            p.sampled(scene)?;
            p.color(picture, Intent::Overwrite)
        },
        |_, _, _| Ok(()),
    )?;
    frame.graph_mut().export(picture)
}
