//! `measure shading-errors`: error of half floats in the shading library on the default adapter.
//!
//! `cargo run -p tests --bin measure -- shading-errors` prints the tables of `docs/measurements/half-floats.md`. Each has a negative control,
//! an error made on purpose that its comparison must detect. The exit code is 1 if it does not.

use crate::{Outcome, adapter, no_words};
use framegraph_shader_mirrors::cases;
use framegraph_wgpu::Gpu;
use std::error::Error;
use tests::measure::half::{Form, LobeError, textbook};
use tests::measure::half_table::{POINTS, ROUGHNESS, SAMPLES, SCENES, Studio, lobes, mirrors};
use tests::mirror;

/// Prints the tables.
pub fn run(words: &[&str]) -> Outcome {
    no_words(words)?;
    let gpu = &adapter()?;
    framegraph_passes::Precision::Half.check(gpu)?;
    let sections = [functions(gpu)?, distribution(gpu)?, pictures(gpu)?];
    Ok(sections.into_iter().all(|noticed| noticed))
}

fn told(noticed: bool) -> bool {
    program::line(format_args!("\nnegative control: {}", if noticed { "detected" } else { "NOT DETECTED" }));
    noticed
}

fn functions(gpu: &Gpu) -> Result<bool, Box<dyn Error>> {
    program::line(format_args!("\n## Functions compared with their f64 mirrors: {POINTS} points each\n"));
    program::line("| function | f32: largest difference | of its bound | f16: largest difference | of its bound |");
    program::line("| --- | --- | --- | --- | --- |");
    for row in mirrors(gpu)? {
        let cell = |d: cases::Deviation| format!("{:.1e} | {:.1} %", d.absolute, 100.0 * d.of_bound);
        program::line(format_args!("| {} | {} | {} |", row.name, cell(row.full), cell(row.half)));
    }
    let cross = cases::half().find(|case| case.function == "d_ggx_cross").ok_or("no d_ggx_cross")?;
    Ok(told(mirror::compare(gpu, &textbook(cross), POINTS).is_err()))
}

fn distribution(gpu: &Gpu) -> Result<bool, Box<dyn Error>> {
    program::line(format_args!(
        "\n## GGX over its lobe: relative error, median / 99th percentile of {SAMPLES} half vectors\n"
    ));
    program::line(format_args!("| roughness | {} |", Form::ALL.map(Form::name).join(" | ")));
    program::line(format_args!("| --- |{}", " --- |".repeat(Form::ALL.len())));
    let mut noticed = false;
    for roughness in ROUGHNESS {
        let errors = lobes(gpu, roughness)?;
        let cell = |e: LobeError| format!("{:.2e} / {:.2e}", e.median, e.p99);
        program::line(format_args!("| {roughness} | {} |", errors.map(cell).join(" | ")));
        let [.., wrong, right] = errors;
        noticed |= wrong.p99 > 10.0 * right.p99;
    }
    Ok(told(noticed))
}

fn pictures(gpu: &Gpu) -> Result<bool, Box<dyn Error>> {
    program::line("\n## Pictures in f16 compared with f32, roughness of at least 0.089 in both\n");
    program::line("| scene | PSNR | pixels that differ by more than 2 steps | largest difference |");
    program::line("| --- | --- | --- | --- |");
    let mut noticed = true;
    for scene in SCENES {
        let studio = Studio::new(gpu, scene)?;
        let d = studio.difference(gpu, 0.089)?;
        program::line(format_args!(
            "| {scene} | {:.1} dB | {:.3} % | {} steps |",
            d.psnr_db,
            100.0 * d.share_off,
            d.largest_codes
        ));
        // Negative control: highlights that are too wide.
        noticed &= scene != "spheres" || studio.difference(gpu, 0.12)?.psnr_db < d.psnr_db - 3.0;
    }
    Ok(told(noticed))
}
