//! Nanoseconds per declared pass of declaring and compiling, on the graphs that peers were measured on.
//!
//! `cargo xtask bench` runs it; every figure is the median of many runs in one process, and what is compared runs in the
//! same process. Prints one table in Markdown.

mod workload;

use framegraph::{Caps, Graph, Options, Plan, Scratch, compile, recompile};
use std::hint::black_box;
use std::time::Instant;
use workload::{Handles, Workload};

/// Median nanoseconds per pass of `run`, over about a second.
fn median_ns(passes: usize, mut run: impl FnMut()) -> f64 {
    let start = Instant::now();
    run();
    let once = start.elapsed().as_secs_f64().max(1e-7);
    let inner = ((2e-4 / once) as usize).max(1);
    let samples = ((1.0 / (once * inner as f64)) as usize).clamp(9, 501);
    let mut times: Vec<f64> = (0..samples)
        .map(|_| {
            let start = Instant::now();
            for _ in 0..inner {
                run();
            }
            start.elapsed().as_secs_f64() * 1e9 / (inner * passes) as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn measure(work: &Workload, row: &mut Vec<String>) {
    let (caps, options) = (Caps { max_texture_texels: 16384, ..Caps::wgpu() }, Options::default());
    let (mut graph, mut handles) = (Graph::new(), Handles::new());
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    let n = work.passes.len();
    let declare = |graph: &mut Graph, handles: &mut Handles| {
        graph.reset();
        if let Err(error) = work.declare(graph, handles) {
            panic!("{error}");
        }
    };
    let declared = median_ns(n, || declare(black_box(&mut graph), &mut handles));
    let compiled = median_ns(n, || {
        if let Err(errors) = compile(black_box(&graph), &caps, &options, &mut scratch, &mut plan) {
            panic!("{errors}");
        }
    });
    let both = median_ns(n, || {
        declare(&mut graph, &mut handles);
        if let Err(errors) = compile(black_box(&graph), &caps, &options, &mut scratch, &mut plan) {
            panic!("{errors}");
        }
    });
    let unchanged = median_ns(n, || {
        let again = recompile(black_box(&graph), &caps, &options, &mut scratch, &mut plan);
        assert!(again.is_ok_and(|compiled| !compiled), "an equal graph was compiled again");
    });
    row.push(format!("| {} | {declared:.1} | {compiled:.1} | {both:.1} | {unchanged:.1} |", work.name));
}

fn main() {
    let works = [
        workload::frame(),
        workload::chain(1000),
        workload::dag(100, 42),
        workload::dag(1000, 42),
        workload::dag(10_000, 42),
        workload::dag(100_000, 42),
    ];
    let mut rows = Vec::new();
    for work in &works {
        measure(work, &mut rows);
    }
    println!("| graph | declare | compile | declare + compile | unchanged graph recognised |");
    println!("| --- | --- | --- | --- | --- |");
    for row in rows {
        println!("{row}");
    }
}
