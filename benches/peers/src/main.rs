//! Compares our compiler with zenfg 0.2 on zenfg's own benchmark: pass i reads buffer i − 1 and writes buffer i, and
//! the last buffer is the output. In each round, both declare and compile the whole graph in one process, alternately.
//!
//! The measured work differs. Our compiler validates, culls, orders and merges. It derives lifetimes, loads, stores and
//! uses, places memory in a pool, and logs a reason for each decision. In that time, zenfg validates content flow by byte
//! range, culls, derives uses and plans its pool. The peer drops its graph after each frame, as its interface requires; ours
//! keeps its memory.

use framegraph::{AccessKind, Caps, Graph, Intent, Options, Plan, Scratch, compile};
use std::hint::black_box;
use std::process::ExitCode;
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

const BYTES: u64 = 64;

struct Ours {
    graph: Graph,
    scratch: Scratch,
    plan: Plan,
    caps: Caps,
    options: Options,
}

impl Ours {
    fn round(&mut self, names: &[(String, String)]) -> Result<usize, Failure> {
        let Self { graph, scratch, plan, caps, options } = self;
        graph.reset();
        let mut previous = None;
        for (pass, buffer) in names {
            previous = Some(graph.add_fn(pass, |p| {
                if let Some(previous) = previous {
                    p.read_buffer(previous, AccessKind::StorageRead)?;
                }
                let own = p.buffer(buffer, BYTES);
                p.write_buffer(own, AccessKind::StorageWrite, Intent::Overwrite)
            })?);
        }
        if let Some(output) = previous {
            graph.export_buffer(output)?;
        }
        compile(graph, caps, options, scratch, plan)?;
        Ok(plan.steps().len())
    }
}

fn zenfg_round(names: &[(String, String)]) -> Result<usize, Failure> {
    use zenfg::{BufferDesc, BufferRange, CompileOptions, FrameGraph, RootReason, WriteContents};
    let mut graph = FrameGraph::new();
    let mut frame = graph.begin_frame();
    let mut previous = None;
    for (name, buffer) in names {
        let own = frame.create_buffer(BufferDesc::new(buffer.as_str(), BYTES))?;
        let mut pass = frame.compute_pass(name.as_str());
        if let Some(previous) = previous {
            let _ = pass.storage_buffer_read(previous, BufferRange::whole())?;
        }
        let _ = pass.storage_buffer_write(own, BufferRange::whole(), WriteContents::Overwrite)?;
        pass.finish()?;
        previous = Some(own);
    }
    if let Some(output) = previous {
        frame.mark_buffer_root(output, BufferRange::whole(), RootReason::Output)?;
    }
    Ok(frame.compile(CompileOptions::default())?.retained_node_count())
}

fn nanoseconds(passes: usize, run: impl FnOnce() -> Result<usize, Failure>) -> Result<f64, Failure> {
    let start = Instant::now();
    let kept = black_box(run()?);
    assert_eq!(kept, passes, "a pass of the chain was dropped");
    Ok(start.elapsed().as_secs_f64() * 1e9 / passes as f64)
}

/// Returns the median and the minimum.
fn sorted(mut times: Vec<f64>) -> [f64; 2] {
    times.sort_by(f64::total_cmp);
    [times[times.len() / 2], times[0]]
}

const HEAD: &str = "\
## Beside a peer

A chain of buffers, declared and compiled again in each round, alternately in one process. Times are nanoseconds per pass, as the
median of 200 rounds with the minimum in parentheses. Our compiler validates, culls and merges. It derives lifetimes, loads,
stores and uses, plans a pool, and logs a reason for each decision. In the same time, zenfg 0.2 validates content flow by byte
range, culls, derives uses and plans its pool. It does not reorder, merge, or derive load and store operations. The target is a
ratio of 10.

| chain of buffers | framegraph, ns | zenfg 0.2, ns | ratio |
| --- | --- | --- | --- |";

fn main() -> ExitCode {
    program::ended("peers", run())
}

fn run() -> Result<(), Failure> {
    program::line(HEAD);
    for passes in [100, 1000] {
        let names: Vec<_> = (0..passes).map(|i| (format!("p{i}"), format!("b{i}"))).collect();
        let mut ours = Ours {
            graph: Graph::new(),
            scratch: Scratch::new(),
            plan: Plan::new(),
            caps: Caps::wgpu(),
            options: Options::default(),
        };
        let (mut a, mut b) = (Vec::new(), Vec::new());
        for round in 0..220 {
            let (x, y) = (nanoseconds(passes, || ours.round(&names))?, nanoseconds(passes, || zenfg_round(&names))?);
            if round >= 20 {
                a.push(x);
                b.push(y);
            }
        }
        let ([ours, least], [theirs, their_least]) = (sorted(a), sorted(b));
        let (ratio, of_least) = (theirs / ours, their_least / least);
        program::line(format_args!(
            "| {passes} | {ours:.0} ({least:.0}) | {theirs:.0} ({their_least:.0}) | {ratio:.1} ({of_least:.1}) |"
        ));
    }
    Ok(())
}
