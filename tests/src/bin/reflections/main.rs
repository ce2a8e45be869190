//! `reflections`: accuracy of screen-space reflections on the default adapter.
//!
//! `cargo run --release -p tests --bin reflections` prints the table of `docs/design/reflections.md`: three mirror balls over
//! a mirror floor, compared with the formulas of `truth::reflection`.

use framegraph_passes::ReflectionSettings;
use framegraph_passes::effects::depth::structure::Resolution;
use framegraph_wgpu::{AdapterRequest, Gpu};
use glam::DVec3;
use std::error::Error;
use std::process::ExitCode;
use tests::measure::reflection::{Found, Stage};

/// Width and height of the picture, in pixels.
const SIZE: [u32; 2] = [320, 240];

fn main() -> ExitCode {
    program::ended("reflections", run())
}

fn run() -> Result<(), Box<dyn Error>> {
    program::no_arguments()?;
    let gpu = Gpu::open(&AdapterRequest::from_env())?;
    program::line(format_args!("adapter: {}", gpu.describe()));
    program::line(
        "\n| rays | mirror | seen: found | off, median | off, 95 % | elsewhere | nothing: found | unseen: found |",
    );
    program::line("| --- | --- | --- | --- | --- | --- | --- | --- |");
    let choices = [
        ("on", Resolution::Full),
        ("on", Resolution::Half),
        ("on:stride=2", Resolution::Full),
        ("on:stride=4", Resolution::Full),
        ("on:stride=8", Resolution::Full),
        ("on:thickness=0.01", Resolution::Full),
        ("on:thickness=0.5", Resolution::Full),
        ("on:bias=0", Resolution::Full),
    ];
    for (text, resolution) in choices {
        let settings = ReflectionSettings::from_text(text)?.ok_or("it is on")?;
        let at = if resolution == Resolution::Half { ", structure at half" } else { "" };
        rows(&format!("`{text}`{at}"), Stage::balls(SIZE).found(&gpu, &settings, resolution)?);
    }
    let mut moved = Stage::balls(SIZE);
    moved.earlier.eye += DVec3::new(0.3, 0.1, -0.2);
    let settings = ReflectionSettings::DEFAULT;
    rows("`on`, the eye 0.37 m away a frame ago", moved.found(&gpu, &settings, Resolution::Full)?);
    Ok(())
}

fn rows(what: &str, found: [Found; 2]) {
    for (mirror, found) in ["floor", "balls"].into_iter().zip(found) {
        let Found { hit, off_px: [median, most], elsewhere, made_up, mistaken, .. } = found;
        let [hit, elsewhere, made_up, mistaken] = [hit, elsewhere, made_up, mistaken].map(|share| 100.0 * share);
        program::line(format_args!(
            "| {what} | {mirror} | {hit:.1} % | {median:.2} px | {most:.2} px | {elsewhere:.2} % | {made_up:.2} % | \
             {mistaken:.0} % |"
        ));
    }
}
