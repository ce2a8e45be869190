//! Tables of the program.

use framegraph_passes::Precision;
use framegraph_passes::SettingsTable;
use framegraph_passes::effects::occlusion::{Gtao, Method, Occluders, OcclusionSettings};
use framegraph_scene::Projection;
use framegraph_wgpu::Gpu;
use std::error::Error;
use std::path::Path;
use tests::measure::columns::{Columns, Off};
use tests::measure::occlusion::{
    Stage, column, corner_columns, corner_error, corner_stage, ground, mean_and_deviation,
};
use truth::occlusion as truth;

type Outcome = Result<(), Box<dyn Error>>;

/// Radius of ambient occlusion in all tables, in m.
const RADIUS_M: f64 = 0.3;
/// Number of frames per time; the minimum counts.
const FRAMES: u32 = 6;
/// Numbers of taps and turns of the spiral, as in the design.
const SPIRALS: [[u32; 2]; 7] = [[3, 1], [5, 2], [7, 5], [11, 6], [16, 7], [32, 13], [64, 25]];

fn settings(text: &str) -> Result<OcclusionSettings, Box<dyn Error>> {
    OcclusionSettings::from_text(text)?.ok_or_else(|| format!("{text}: ambient occlusion is off").into())
}

/// Averages blocks of 4×4 texels: the most that a blur can do without additional information.
fn blocks(stage: &Stage, texels: &[f32]) -> Vec<f32> {
    let [width, height] = stage.size_px.map(|side| side as usize);
    let mean = |x: usize, y: usize| {
        let [x, y] = [x / 4 * 4, y / 4 * 4];
        (0..16).map(|i| texels[(y + i / 4) * width + x + i % 4]).sum::<f32>() / 16.0
    };
    (0..width * height).map(|i| mean(i % width, i / width)).collect()
}

/// Returns the noise before and after averaging blocks, then the mean deviation of columns from `converged`.
fn noise_and_bias(stage: &Stage, texels: &[f32], converged: &[f32]) -> [f64; 3] {
    let blocked = blocks(stage, texels);
    let columns = corner_columns(stage, RADIUS_M);
    let mean = |of: &dyn Fn(u32) -> f64| columns.iter().map(|(x, _)| of(*x)).sum::<f64>() / columns.len() as f64;
    let statistics = |texels: &[f32], x| mean_and_deviation(&column(stage, texels, x));
    let variance = |texels: &[f32]| mean(&|x| statistics(texels, x)[1].powi(2)).sqrt();
    let apart = mean(&|x| (statistics(texels, x)[0] - statistics(converged, x)[0]).abs());
    [variance(texels), variance(&blocked), apart]
}

/// Prints noise, bias and time of unblurred SAO by number of taps, at full and half resolution.
pub fn taps(gpu: &Gpu) -> Outcome {
    program::line("\n| taps (turns) | σ | σ of 4×4 | off converged | ms | half: σ | σ of 4×4 | off converged | ms |");
    program::line("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let stages = [corner_stage(256)?, corner_stage(128)?];
    let frames = [Stage::new(Projection::perspective(0.8, 0.1), [1280, 720], ground(4.0, 45.0))?, {
        Stage::new(Projection::perspective(0.8, 0.1), [640, 360], ground(4.0, 45.0))?
    }];
    let plain = OcclusionSettings { blur: None, bias: 0.0, ..OcclusionSettings::SAO };
    let spiral = |taps, turns| OcclusionSettings { method: Method::Sao { taps, turns }, ..plain };
    let converged = stages.each_ref().map(|stage| stage.visibility(gpu, &spiral(1024, 397), Precision::Full));
    let [full, half] = converged;
    let converged = [full?, half?];
    for [taps, turns] in SPIRALS {
        program::print(format_args!("| {taps} ({turns})"));
        for (index, stage) in stages.iter().enumerate() {
            let made = stage.visibility(gpu, &spiral(taps, turns), Precision::Full)?;
            let [noise, blocked, off] = noise_and_bias(stage, &made, &converged[index]);
            let (_, ms) = frames[index].occlusion(gpu, &spiral(taps, turns), Precision::Full, FRAMES)?;
            program::print(format_args!(" | {noise:.3} | {blocked:.3} | {off:.3} | {ms:.1}"));
        }
        program::line(" |");
    }
    Ok(())
}

/// Compares each method, with its blur, to the references of the corner and the columns.
pub fn methods(gpu: &Gpu) -> Outcome {
    program::line("\n| method | corner RMS | columns RMS | bias | as shaded | at half | ms |");
    program::line("| --- | --- | --- | --- | --- | --- | --- |");
    let columns = Columns::open(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/references/filament_frame")))?;
    let stage = corner_stage(256)?;
    let frame = Stage::new(Projection::perspective(0.8, 0.1), [1280, 720], ground(4.0, 45.0))?;
    for text in [
        "sao",
        "sao:quality=medium",
        "sao:quality=high",
        "sao:quality=ultra",
        "sao:quality=ultra,normals=coarse,place=filament",
        "gtao",
        "gtao:blur=medium",
        "gtao:blur=high",
        "gtao:steps=3",
        "gtao:slices=3,steps=3",
        "gtao:slices=3,steps=3,blur=high",
        "gtao:slices=4,steps=3",
        "gtao:slices=4,steps=3,occluders=fading",
        "gtao:slices=4,steps=8",
        "gtao:occluders=0.5",
        "gtao:bent-normals=on",
    ] {
        let own = settings(text)?;
        let corner = corner_error(&stage, &stage.visibility(gpu, &own, Precision::Full)?, RADIUS_M);
        let Off { rms, bias } = columns.off(gpu, own)?;
        let shaded = columns.off_as_shaded(gpu, own)?.rms;
        let half = columns.off_as_shaded(gpu, settings(&halved(text))?)?.rms;
        let (_, ms) = frame.occlusion(gpu, &own, Precision::Full, FRAMES)?;
        program::line(format_args!(
            "| `{text}` | {corner:.3} | {rms:.3} | {bias:+.3} | {shaded:.3} | {half:.3} | {ms:.1} |"
        ));
    }
    Ok(())
}

/// Returns the text of a method with half resolution.
fn halved(text: &str) -> String {
    let joint = if text.contains(':') { "," } else { ":" };
    format!("{text}{joint}resolution=half")
}

/// Prints the minimum and mean visibility of ground without occluders.
pub fn open_ground(gpu: &Gpu) -> Outcome {
    program::line("\n| open ground, tilted by | 0° | 45° | 70° | 85° |");
    program::line("| --- | --- | --- | --- | --- |");
    for text in ["sao:quality=ultra", "gtao", "gtao:occluders=0.5", "sao:quality=ultra,place=filament,normals=coarse"] {
        program::print(format_args!("| `{text}`, mean (least)"));
        for tilt in [0.0, 45.0, 70.0, 85.0] {
            let stage = Stage::new(Projection::perspective(0.8, 0.1), [320, 180], ground(5.0, tilt))?;
            let made = stage.visibility(gpu, &settings(text)?, Precision::Full)?;
            let covered = made.iter().zip(&stage.depth).filter(|(_, depth)| **depth > 0.0);
            let covered: Vec<f64> = covered.map(|(visibility, _)| f64::from(*visibility)).collect();
            let least = covered.iter().copied().fold(1.0, f64::min);
            program::print(format_args!(" | {:.3} ({least:.3})", mean_and_deviation(&covered)[0]));
        }
        program::line(" |");
    }
    Ok(())
}

/// Compares the converged result of each method with the reference.
pub fn corner(gpu: &Gpu) -> Outcome {
    program::line("\n| from the edge | 0.02 m | 0.05 m | 0.1 m | 0.15 m | 0.2 m |");
    program::line("| --- | --- | --- | --- | --- | --- |");
    let stage = corner_stage(256)?;
    let columns = corner_columns(&stage, 1.0);
    let wanted = [0.02, 0.05, 0.1, 0.15, 0.2];
    let row = |name: &str, of: &dyn Fn(u32, f64) -> f64| {
        program::print(format_args!("| {name}"));
        for wanted in wanted {
            let near = columns.iter().min_by(|a, b| (a.1 - wanted).abs().total_cmp(&(b.1 - wanted).abs()));
            if let Some((x, distance_m)) = near {
                program::print(format_args!(" | {:.3}", of(*x, *distance_m)));
            }
        }
        program::line(" |");
    };
    row("truth", &|_, distance_m| truth::corner(distance_m, RADIUS_M));
    let plain = OcclusionSettings { blur: None, bias: 0.0, ..OcclusionSettings::SAO };
    let sao = OcclusionSettings { method: Method::Sao { taps: 1024, turns: 397 }, ..plain };
    let gtao = |occluders| {
        let method = Method::Gtao(Gtao { slices: 16, steps: 64, step_power: 1.0, occluders });
        OcclusionSettings { method, blur: None, ..OcclusionSettings::GTAO }
    };
    for (name, settings) in [
        ("SAO converged", sao),
        ("GTAO converged", gtao(Occluders::Solid)),
        ("GTAO converged, 0.5 m thick", gtao(Occluders::Thick(0.5))),
        ("GTAO converged, Filament's falloff", gtao(Occluders::Fading)),
    ] {
        let made = stage.visibility(gpu, &settings, Precision::Full)?;
        row(name, &|x, _| mean_and_deviation(&column(&stage, &made, x))[0]);
    }
    Ok(())
}
