//! What large scenes cost the CPU, on wgpu's device that validates and draws nothing; printed in Markdown.

mod cull;
mod frames;
mod workload;

use std::time::Instant;

fn main() -> std::process::ExitCode {
    program::ended("scenes", frames::print().map(|()| cull::print()))
}

/// Milliseconds that this thread has run: waiting for other programs is not in it. Where the system does not tell (Linux does), the time since
/// `start`.
fn cpu_ms(start: Instant) -> f64 {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let ran_ns = text.split_whitespace().next().and_then(|ns| ns.parse::<f64>().ok());
    ran_ns.map_or_else(|| 1e3 * start.elapsed().as_secs_f64(), |ns| 1e-6 * ns)
}

/// The median, and the least, of `runs` numbers.
fn median_of(runs: usize, mut run: impl FnMut() -> f64) -> (f64, f64) {
    let mut all: Vec<f64> = (0..runs).map(|_| run()).collect();
    all.sort_by(f64::total_cmp);
    (all[runs / 2], all[0])
}
