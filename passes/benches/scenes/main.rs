//! What large scenes cost the CPU, on wgpu's device that validates and draws nothing; printed in Markdown.

mod cull;
mod frames;
mod workload;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    frames::print()?;
    cull::print();
    Ok(())
}

/// The median, and the least, of `runs` numbers.
fn median_of(runs: usize, mut run: impl FnMut() -> f64) -> (f64, f64) {
    let mut all: Vec<f64> = (0..runs).map(|_| run()).collect();
    all.sort_by(f64::total_cmp);
    (all[runs / 2], all[0])
}
