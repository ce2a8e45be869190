//! CPU cost of large scenes on wgpu's no-op device, printed as Markdown.

mod cull;
mod frames;
mod workload;

use std::time::Instant;

fn main() -> std::process::ExitCode {
    program::ended("scenes", frames::print().map(|()| cull::print()))
}

/// Returns the CPU time of this thread in milliseconds. On systems other than Linux, returns the time since `start`.
fn cpu_ms(start: Instant) -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let ran_ns = text.split_whitespace().next().and_then(|ns| ns.parse::<f64>().ok());
    ran_ns.map_or_else(|| 1e3 * start.elapsed().as_secs_f64(), |ns| 1e-6 * ns)
}

/// Returns the median and the minimum of `runs` numbers.
fn median_of(runs: usize, mut run: impl FnMut() -> f64) -> (f64, f64) {
    let mut all: Vec<f64> = (0..runs).map(|_| run()).collect();
    all.sort_by(f64::total_cmp);
    (all[runs / 2], all[0])
}
