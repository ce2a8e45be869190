//! A warm graph, scratch and plan do not allocate: 10,000 frames of declaring and compiling with a counting allocator,
//! with one plan and with several in turn.
//!
//! This is a program without the test harness, because the allocator counts for the whole process, and the harness
//! allocates when it reports a slow test.

#[allow(dead_code, reason = "the bench prints the names of the workloads")]
#[path = "../benches/compile/workload.rs"]
mod workload;

use framegraph::{Alias, Caps, CompileErrors, Graph, Options, Order, Plan, Scratch, compile, recompile};
use stats_alloc::{INSTRUMENTED_SYSTEM, Region, StatsAlloc};
use std::alloc::System;
use workload::{Handles, Workload};

#[global_allocator]
static COUNTING: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// Number of frames without allocation on the main device, and on each of the others.
const FRAMES: usize = 10_000;
const FRAMES_ELSEWHERE: usize = 500;

/// Number of frames with the optimizing order and a heap, which take a thousand times as long.
const FRAMES_THOROUGH: usize = 3;

/// Number of plans that are compiled in turn, each holding its graph's arrays.
const PLANS: usize = 3;

struct Warm {
    graph: Graph,
    handles: Handles,
    scratch: Scratch,
    plans: [Plan; PLANS],
}

impl Warm {
    fn declare(&mut self, work: &Workload) {
        self.graph.reset();
        work.declare(&mut self.graph, &mut self.handles).expect("the workload is valid");
    }
}

/// Compiles into one plan, then declares an equal frame and recognizes it as unchanged.
fn frame(work: &Workload, caps: &Caps, options: &Options, warm: &mut Warm, turn: usize) {
    warm.declare(work);
    let Warm { graph, scratch, plans, .. } = warm;
    let compiled: Result<(), CompileErrors> = compile(graph, caps, options, scratch, &mut plans[turn]);
    compiled.expect("the workload compiles");
    warm.declare(work);
    let Warm { graph, scratch, plans, .. } = warm;
    let again = recompile(graph, caps, options, scratch, &mut plans[turn]);
    assert_eq!(again, Ok(false), "an equal graph was compiled again");
}

fn main() {
    let works = [workload::frame(), workload::chain(100), workload::dag(100, 42)];
    for work in &works {
        check(work, Caps::wgpu(), Options::default(), FRAMES);
        check(work, Caps::desktop(), Options::default(), FRAMES_ELSEWHERE);
        check(work, Caps::tiler(), Options::default(), FRAMES_ELSEWHERE);
        let thorough = Options { order: Order::Optimized, alias: Alias::Heap, ..Options::default() };
        check(work, Caps::tiler(), thorough, FRAMES_THOROUGH);
    }
}

/// Checks `frames` frames, first with one plan and then with several in turn, after warming up.
fn check(work: &Workload, caps: Caps, options: Options, frames: usize) {
    let caps = Caps { max_texture_texels: 16384, ..caps };
    for plans in [1, PLANS] {
        let mut warm = Warm {
            graph: Graph::new(),
            handles: Handles::new(),
            scratch: Scratch::new(),
            plans: std::array::from_fn(|_| Plan::new()),
        };
        let cold = Region::new(COUNTING);
        for turn in 0..2 * plans {
            frame(work, &caps, &options, &mut warm, turn % plans);
        }
        let first = cold.change().allocations;
        assert!(first > 0, "the counter does not count");
        let region = Region::new(COUNTING);
        for turn in 0..frames {
            frame(work, &caps, &options, &mut warm, turn % plans);
        }
        let change = region.change();
        let moved = (change.allocations, change.reallocations, change.deallocations);
        assert_eq!(moved, (0, 0, 0), "{} for {}, {plans} plans", work.name, caps.name);
        program::line(format_args!(
            "{} for {}, {plans} plans in turn: {frames} frames, no allocation ({first} while warming up)",
            work.name, caps.name
        ));
    }
}
