//! Measures declaring and compiling: time, instructions and memory, on the graphs used for other render graphs.
//!
//! `cargo xtask bench` runs it, and `docs/measurements/performance.md` is its output. All compared cases run in one process. With
//! `--count GRAPH WHAT FRAMES` it only runs frames, for a profiler that counts instructions.

mod count;
mod heap;
mod memory;
mod time;
mod workload;

use framegraph::{Caps, Graph, Options, Plan, Scratch, compile};
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;
use std::process::ExitCode;
use workload::{Handles, Workload};

#[global_allocator]
static COUNTING: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// A graph that is declared again in each frame, and its plan.
struct Frames {
    work: Workload,
    graph: Graph,
    handles: Handles,
    scratch: Scratch,
    plan: Plan,
    caps: Caps,
    options: Options,
}

impl Frames {
    fn new(work: Workload) -> Self {
        let caps = Caps { max_texture_texels: 16384, ..Caps::wgpu() };
        Self::with(work, caps, Options::default())
    }

    fn with(work: Workload, caps: Caps, options: Options) -> Self {
        let (graph, handles) = (Graph::new(), Handles::new());
        Self { work, graph, handles, scratch: Scratch::new(), plan: Plan::new(), caps, options }
    }

    fn passes(&self) -> usize {
        self.work.passes.len()
    }

    fn declare(&mut self) {
        self.graph.reset();
        self.work.declare(&mut self.graph, &mut self.handles).unwrap_or_else(|error| panic!("{error}"));
    }

    fn compile(&mut self) {
        let Self { graph, scratch, plan, caps, options, .. } = self;
        compile(graph, caps, options, scratch, plan).unwrap_or_else(|errors| panic!("{errors}"));
    }
}

/// The graphs, each with its target for declaring and compiling in nanoseconds per pass.
fn works() -> [(Workload, Option<u32>); 6] {
    [
        (workload::frame(), Some(80)),
        (workload::chain(1000), Some(80)),
        (workload::dag(100, 42), None),
        (workload::dag(1000, 42), Some(120)),
        (workload::dag(10_000, 42), None),
        (workload::dag(100_000, 42), Some(200)),
    ]
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).filter(|a| a != "--bench").collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => {
            time::print();
            heap::print();
            memory::print();
        }
        ["--count", graph, what, frames] => return program::ended("compile", count::run(graph, what, frames)),
        _ => return program::ended("compile", Err("usage: --count GRAPH (declare|compile) FRAMES")),
    }
    program::exit(0)
}
