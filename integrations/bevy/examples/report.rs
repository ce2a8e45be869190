//! Reports what a render graph would save in Bevy's frame.
//!
//! `cargo run --ignore-rust-version --example report -- [FOLDER] [--samples 1|4] [--size WIDTHxHEIGHT]` renders the scene, prints the
//! report, and writes `frame.ron` to the folder.

#[allow(dead_code, reason = "the other example reads pictures")]
mod support;

use bevy_render::view::Tonemapping;
use framegraph_bevy::{Device, Report, ReportPlugin};
use std::path::PathBuf;
use support::{Choice, Scene};

/// Index of the reported frame: late enough that all pipelines exist.
const FRAME: u32 = 6;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (mut folder, mut samples, mut size) = (PathBuf::from("target/report"), 4, [1280, 720]);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--samples" => samples = arguments.next().ok_or("--samples: 1 or 4 is missing")?.parse()?,
            "--size" => {
                let text = arguments.next().ok_or("--size: WIDTHxHEIGHT is missing")?;
                let (width, height) = text.split_once('x').ok_or("--size: write WIDTHxHEIGHT")?;
                size = [width.parse()?, height.parse()?];
            }
            _ => folder = argument.into(),
        }
    }
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
