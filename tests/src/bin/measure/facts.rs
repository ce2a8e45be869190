//! `measure facts`: effects that feature culling drops from six scenes under four presets, and the time saved.
//!
//! `cargo run --release -p tests --bin measure -- facts` prints the tables of `docs/design/feature-culling.md`. `--every-mask` draws all 4096
//! combinations of twelve effects in each of six small scenes, with and without feature culling, and compares them.
//! `--masks N` draws N evenly spread combinations instead. `--scene NAME` selects one scene.

use crate::{Outcome, adapter};
use framegraph_wgpu::Gpu;
use program::progress::Shown;
use std::error::Error;
use std::time::Instant;
use tests::measure::facts::table::{bare, heads, rows};
use tests::measure::facts::{Drawn, Easel, MASKED, cases, compare_mask};

/// Prints the tables, or compares masks.
pub fn run(words: &[&str]) -> Outcome {
    let number = |text: &str| text.parse().ok().filter(|count| (1..=ALL_MASKS).contains(count));
    let names = cases().map(|case| case.name);
    let (rest, scene) = match words {
        [rest @ .., "--scene", name] if names.contains(name) => (rest, Some(*name)),
        rest => (rest, None),
    };
    let masks = match rest {
        [] if scene.is_none() => None,
        ["--every-mask"] => Some(ALL_MASKS),
        ["--masks", count] if number(count).is_some() => number(count),
        _ => {
            return Err(format!(
                "{}: use --every-mask or --masks N (1 to 4096), optionally followed by --scene NAME with one of {}",
                words.join(" "),
                names.join(", ")
            )
            .into());
        }
    };
    let gpu = adapter()?;
    match masks {
        Some(count) => draw_masks(&gpu, count, scene)?,
        None => print(&gpu)?,
    }
    Ok(true)
}

fn print(gpu: &Gpu) -> Result<(), Box<dyn Error>> {
    let load = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    program::line(format_args!("load: {}", load.split(' ').next().unwrap_or("unknown")));
    program::line(format_args!("\n<!-- table: facts -->\n{}", heads()));
    for row in rows(gpu, true)? {
        program::line(row);
    }
    program::line("<!-- end -->");
    let (bare_ms, decided_ms) = bare(gpu)?;
    let more = 100.0 * (decided_ms / bare_ms - 1.0);
    program::line(format_args!(
        "\nthe bare frame takes {bare_ms:.3} ms, the ultra one of a scene that needs nothing {decided_ms:.3} ms with deciding: {more:+.1} %"
    ));
    Ok(())
}

/// Number of combinations of effects.
const ALL_MASKS: u32 = 1 << MASKED.len();

fn draw_masks(gpu: &Gpu, count: u32, scene: Option<&str>) -> Result<(), Box<dyn Error>> {
    let mut easel = Easel::new(gpu);
    program::line("| scene | masks | pictures that differ | largest difference, codes | beyond their bounds | s |");
    program::line("| --- | --- | --- | --- | --- | --- |");
    for case in cases().into_iter().filter(|case| scene.is_none_or(|name| name == case.name)) {
        let mut drawn = Drawn::new(gpu, case)?;
        let (mut shown, begun) = (Shown::default(), Instant::now());
        let (mut differ, mut largest, mut beyond) = (0, 0, 0);
        for number in 0..count {
            // The step is odd, so that every mask occurs once. It is near the golden ratio of the count, so that a few
            // masks are spread evenly.
            let mask = number * 2531 % ALL_MASKS;
            let found = compare_mask(&mut easel, &mut drawn, mask)?;
            differ += u32::from(found.largest_codes > 0);
            largest = largest.max(found.largest_codes);
            if !found.holds() {
                beyond += 1;
                shown.clear();
                program::note(format_args!("{} {mask:012b}: {found:?}", drawn.case.name));
            }
            shown.step(drawn.case.name, number as usize + 1, count as usize, "");
        }
        shown.clear();
        let (name, seconds) = (drawn.case.name, begun.elapsed().as_secs());
        program::line(format_args!("| {name} | {count} | {differ} | {largest} | {beyond} | {seconds} |"));
    }
    Ok(())
}
