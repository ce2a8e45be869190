//! A warm graph, scratch and plan allocate nothing: 10,000 frames of declaring and compiling under a counting allocator.
//!
//! A program of its own without the test harness, since the allocator counts for the whole process, and the harness
//! allocates when it reports a slow test.

#[allow(dead_code, reason = "the bench prints the names of the workloads")]
#[path = "../benches/compile/workload.rs"]
mod workload;

use framegraph::{Caps, CompileErrors, Graph, Options, Plan, Scratch, compile, recompile};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;
use workload::{Handles, Workload};

#[global_allocator]
static COUNTING: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Frames that must allocate nothing on the device of the contract, and on each of the others.
const FRAMES: usize = 10_000;
const FRAMES_ELSEWHERE: usize = 500;

struct Warm {
    graph: Graph,
    handles: Handles,
    scratch: Scratch,
    plan: Plan,
}

fn frame(work: &Workload, caps: &Caps, options: &Options, warm: &mut Warm) {
    let Warm { graph, handles, scratch, plan } = warm;
    graph.reset();
    work.declare(graph, handles).expect("the workload is sound");
    let compiled: Result<(), CompileErrors> = compile(graph, caps, options, scratch, plan);
    compiled.expect("the workload compiles");
    let again = recompile(graph, caps, options, scratch, plan);
    assert_eq!(again, Ok(false), "an equal graph was compiled again");
}

fn main() {
    let works = [workload::frame(), workload::chain(100), workload::dag(100, 42)];
    for work in &works {
        check(work, Caps::wgpu(), FRAMES);
        check(work, Caps::desktop(), FRAMES_ELSEWHERE);
        check(work, Caps::tiler(), FRAMES_ELSEWHERE);
    }
}

/// Declares and compiles `frames` frames after two that warm up.
fn check(work: &Workload, caps: Caps, frames: usize) {
    let caps = Caps { max_texture_texels: 16384, ..caps };
    let options = Options::default();
    let mut warm = Warm { graph: Graph::new(), handles: Handles::new(), scratch: Scratch::new(), plan: Plan::new() };
    let cold = Region::new(COUNTING);
    for _ in 0..2 {
        frame(work, &caps, &options, &mut warm);
    }
    let first = cold.change().allocations;
    assert!(first > 0, "the counter does not count");
    let region = Region::new(COUNTING);
    for _ in 0..frames {
        frame(work, &caps, &options, &mut warm);
    }
    let change = region.change();
    let moved = (change.allocations, change.reallocations, change.deallocations);
    assert_eq!(moved, (0, 0, 0), "{} for {}", work.name, caps.name);
    println!("{} for {}: {frames} frames, no allocation ({first} while warming up)", work.name, caps.name);
}
