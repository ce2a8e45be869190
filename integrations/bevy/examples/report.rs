//! Reports what a render graph would save in Bevy's frame.
//!
//! `cargo run --ignore-rust-version --example report -- [FOLDER] [--samples 1|4] [--size WIDTHxHEIGHT]` renders the scene, prints the
//! report, and writes `frame.ron` to the folder.

mod support;

use bevy_render::view::Tonemapping;
use framegraph_bevy::{Device, Report, ReportPlugin};
use support::{Arguments, Choice, Scene};

/// Index of the reported frame: late enough that all pipelines exist.
const FRAME: u32 = 6;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let Arguments { folder, samples, size } = Arguments::parse("target/report")?;
    let device = Device::open(Some(&folder.join("trace")))?;
    let choice = Choice { size, samples, bloom: true, tonemapping: Tonemapping::AcesFitted, fxaa: true };
    let mut scene = Scene::new(&device, &choice, |app| {
        app.add_plugins(ReportPlugin);
    });
    scene.frames(&device, FRAME + 3);
    let report = Report::of_trace(&folder.join("trace"), FRAME, &device.gpu().caps())?;
    print!("{}", report.markdown());
    std::fs::write(folder.join("frame.ron"), report.ron("bevy"))?;
    Ok(())
}
