//! Speedup of recording on several threads. Compares one thread, always several threads, and the automatic choice.

use crate::executed::Executed;
use crate::shared::Case;
use framegraph_wgpu::Gpu;
use std::error::Error;
use std::time::Instant;

const CASES: [Case; 4] = [
    Case { passes: 5, draws: 1 },
    Case { passes: 50, draws: 1 },
    Case { passes: 50, draws: 100 },
    Case { passes: 50, draws: 1000 },
];
/// Number of blocks of each variant. Variants alternate in blocks, since threads that have just worked stay awake for a
/// while.
const BLOCKS: usize = 24;
/// Number of frames in a block. All blocks together contain more than one trial of the automatic choice.
const BLOCK: usize = 100;
/// Number of frames at the start of a block that are not counted.
const WARM_UP: usize = 10;

/// Prints the table.
pub fn print() -> Result<(), Box<dyn Error>> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    program::line("### Threads\n");
    program::line(
        "| passes × draws | threads | one thread, µs | always on all, µs | speed-up | automatic, µs | speed-up | on threads |",
    );
    program::line("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for case in CASES {
        for threads in (1..=cores.ilog2().max(1)).map(|doublings| 1 << doublings) {
            row(case, threads)?;
        }
    }
    program::line("");
    Ok(())
}

fn row(case: Case, threads: usize) -> Result<(), Box<dyn Error>> {
    let gpu = Gpu::noop()?;
    let own = || Executed::new(&gpu, case, false);
    let mut all = [own()?, own()?.on_threads(threads, true)?, own()?.on_threads(threads, false)?];
    let mut times = [const { Vec::new() }; 3];
    for _ in 0..BLOCKS {
        for (executed, times) in all.iter_mut().zip(&mut times) {
            for frame in 0..BLOCK {
                let start = Instant::now();
                executed.frame()?;
                if frame >= WARM_UP {
                    times.push(1e6 * start.elapsed().as_secs_f64());
                }
            }
        }
    }
    let [one, always, automatic] = times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    });
    let Case { passes, draws } = case;
    program::line(format_args!(
        "| {passes} × {draws} | {threads} | {one:.1} | {always:.1} | {:.2} | {automatic:.1} | {:.2} | {} |",
        one / always,
        one / automatic,
        all[2].threads()
    ));
    Ok(())
}
