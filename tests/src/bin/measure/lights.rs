//! `measure lights`: cost of many lights with froxels and with a loop over all lights, on the default adapter.
//!
//! `cargo run --release -p tests --bin measure -- lights` prints the tables of `docs/design/lights.md`. Each time is the minimum of
//! several frames, and valid for this device only.

use crate::{Outcome, adapter, no_words};
use framegraph_passes::gpu_scene::punctual::{Found, FroxelSettings, LightSearch};
use framegraph_passes::{CameraView, Settings};
use framegraph_scene::{LightKind, Scene, progress};
use framegraph_wgpu::Gpu;
use std::error::Error;
use tests::measure::lights::Night;

/// Width and height of the pictures, in pixels.
const SIZE_PX: [u32; 2] = [640, 360];
/// Number of frames per time; the minimum counts.
const FRAMES: u32 = 3;
/// Number of views per time; the minimum counts.
const VIEWS: u32 = 9;
/// Sample points in each light for the second table.
const SAMPLES: u32 = 20_000;

/// Prints the tables.
pub fn run(words: &[&str]) -> Outcome {
    no_words(words)?;
    let gpu = adapter()?;
    times(&gpu)?;
    lists(&gpu)?;
    Ok(true)
}

fn night(gpu: &Gpu, name: &str) -> Result<Night, Box<dyn Error>> {
    let scene = Scene::open(name, &mut progress::silent)?;
    let camera = scene.default_camera(f64::from(SIZE_PX[0]) / f64::from(SIZE_PX[1]));
    Night::new(gpu, scene, camera, SIZE_PX, Settings { shadows: None, ..Settings::DEFAULT })
}

/// Measures frames with froxels and with all lights, and the CPU time of building the lists.
fn times(gpu: &Gpu) -> Result<(), Box<dyn Error>> {
    program::line("\n| lamps | a list | longest list | lists, ms | froxels, ms | all, ms | largest difference |");
    program::line("| --- | --- | --- | --- | --- | --- | --- |");
    let froxels = LightSearch::Froxels(FroxelSettings::DEFAULT);
    for count in [0, 1, 2, 4, 8, 10, 16, 32, 100, 300, 1000] {
        let mut night = night(gpu, &format!("lamps:{count}"))?;
        let view = night.view(froxels);
        let (mean, longest) = length(&view)?;
        let by_froxels = night.shoot(gpu, view, FRAMES)?;
        let all = night.shoot(gpu, night.view(LightSearch::All), FRAMES)?;
        let pairs = by_froxels.linear.iter().flatten().zip(all.linear.iter().flatten());
        let largest = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        let made_ms = night.view_ms(froxels, VIEWS) - night.view_ms(LightSearch::All, VIEWS);
        program::line(format_args!(
            "| {count} | {mean:.2} | {longest} | {made_ms:.2} | {:.1} | {:.1} | {largest} |",
            by_froxels.ms, all.ms
        ));
    }
    Ok(())
}

/// Returns the mean and maximum length of a view's lists.
fn length(view: &CameraView) -> Result<(f64, usize), Box<dyn Error>> {
    match view.light_report.found {
        Found::ByFroxels { counts, entries, longest, .. } => {
            Ok((entries as f64 / f64::from(counts.iter().product::<u32>()), longest))
        }
        Found::All(_) => Err("the view has no light lists".into()),
    }
}

/// Compares the number of list entries with the number needed.
fn lists(gpu: &Gpu) -> Result<(), Box<dyn Error>> {
    program::line("\n| lamps | froxels | entries | needed | entries for each needed | lists, ms |");
    program::line("| --- | --- | --- | --- | --- | --- |");
    let cuts = [
        FroxelSettings::DEFAULT,
        FroxelSettings { tiles: 512, ..FroxelSettings::DEFAULT },
        FroxelSettings { slices: 32, ..FroxelSettings::DEFAULT },
        FroxelSettings { tiles: 512, slices: 32, near_m: 2.0, far_m: 60.0 },
    ];
    for (what, keeps) in [("points", 0), ("spots", 1)] {
        let mut night = night(gpu, "lamps")?;
        night.scene.lights.retain(|light| matches!(light.kind, LightKind::Spot { .. }) == (keeps == 1));
        for cut in cuts {
            let search = LightSearch::Froxels(cut);
            let view = night.view(search);
            let lists = view.light_lists.as_ref().ok_or("the view has no light lists")?;
            let [x, y, z] = lists.uniforms.counts;
            let entries = lists.words.len() - (x * y * z) as usize - 1;
            let needed = night.touched(lists, [cut.near_m, cut.far_m].map(f64::from), SAMPLES);
            let made_ms = night.view_ms(search, VIEWS) - night.view_ms(LightSearch::All, VIEWS);
            program::line(format_args!(
                "| {} {what} | {x}×{y}×{z} | {entries} | {needed} | {:.2} | {made_ms:.2} |",
                night.scene.lights.len(),
                entries as f64 / needed.max(1) as f64
            ));
        }
    }
    Ok(())
}
