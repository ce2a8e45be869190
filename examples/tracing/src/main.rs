//! Writes a trace of a few frames: `cargo run -p tracing_example -- trace.json`. Open the file in
//! <https://ui.perfetto.dev>.

use framegraph::{ClearValue, DeclareError, Extent, Format, Intent, TextureDesc};
use framegraph_wgpu::{Frame, FrameLoop, Gpu};
use std::error::Error;
use std::process::ExitCode;
use tracing_example::ChromeTrace;

fn main() -> ExitCode {
    program::ended("traced_frames", run())
}

fn run() -> Result<(), Box<dyn Error>> {
    let path = std::env::args_os().nth(1).ok_or("name the file to write, for example trace.json")?;
    let trace = ChromeTrace::default();
    tracing::subscriber::set_global_default(trace.clone())?;
    let mut frames = FrameLoop::<()>::new(&Gpu::noop()?);
    for _ in 0..10 {
        frames.run([640, 360], &(), |frame, _| declare(frame))?;
    }
    std::fs::write(&path, trace.json().to_string())?;
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
