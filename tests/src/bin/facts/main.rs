//! `facts`: what facts leave out of six scenes under four presets, and what that saves.
//!
//! `cargo run --release -p tests --bin facts` prints the tables of `docs/facts.md`; with `--every-mask` it draws all 4096
//! combinations of twelve effects in each of six small scenes, as asked for and as decided, and compares.

#![warn(clippy::print_stdout, clippy::print_stderr)]

use framegraph_passes::ibl::cache::Cache;
use framegraph_wgpu::{AdapterRequest, Gpu};
use program::progress::Shown;
use std::error::Error;
use std::process::ExitCode;
use tests::measure::facts::table::{bare, heads, rows};
use tests::measure::facts::{Drawn, Easel, MASKED, cases, compare_mask};

type Outcome = Result<(), Box<dyn Error>>;

fn main() -> ExitCode {
    let every = match std::env::args().nth(1).as_deref() {
        None => false,
        Some("--every-mask") => true,
        Some(other) => {
            program::error(format_args!("facts: {other}: unknown option; there is --every-mask"));
            return program::exit(2);
        }
    };
    let done = Gpu::open(&AdapterRequest::from_env()).map_err(Box::from).and_then(|gpu| {
        program::line(format_args!("adapter: {}", gpu.describe()));
        if every { every_mask(&gpu) } else { print(&gpu) }
    });
    match done {
        Ok(()) => program::exit(0),
        Err(error) => {
            program::error(format_args!("facts: {error}"));
            program::exit(1)
        }
    }
}

fn print(gpu: &Gpu) -> Outcome {
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

fn every_mask(gpu: &Gpu) -> Outcome {
    let mut easel = Easel::new(gpu);
    program::line("| scene | masks | pictures that differ | largest difference, codes | beyond their bounds |");
    program::line("| --- | --- | --- | --- | --- |");
    for case in cases() {
        let mut drawn = Drawn::new(gpu, case, &Cache::from_env())?;
        let (all, mut shown) = (1_u32 << MASKED.len(), Shown::default());
        let (mut differ, mut largest, mut beyond) = (0, 0, 0);
        for mask in 0..all {
            let found = compare_mask(&mut easel, &mut drawn, mask)?;
            differ += u32::from(found.largest_codes > 0);
            largest = largest.max(found.largest_codes);
            beyond += u32::from(!found.holds());
            shown.step(drawn.case.name, mask as usize + 1, all as usize, "");
        }
        shown.clear();
        program::line(format_args!("| {} | {all} | {differ} | {largest} | {beyond} |", drawn.case.name));
    }
    Ok(())
}
