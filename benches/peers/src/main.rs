//! The compiler beside zenfg 0.2 on the peer's own chain: pass i reads buffer i − 1 and writes buffer i, the last buffer is
//! the output. Both declare and compile the whole graph anew in each round, in turns, in one process.
//!
//! What each does in that time: framegraph validates, culls, orders, merges, derives lifetimes, loads, stores and uses,
//! places memory in a pool and logs a reason for each decision; zenfg validates content flow by byte range, culls, derives
//! uses and plans its pool. zenfg's graph is dropped after each frame, as its interface asks; ours keeps its memory.

use framegraph::{AccessKind, Caps, Graph, Intent, Options, Plan, Scratch, compile};
use std::hint::black_box;
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
            graph.export_buffer(output);
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

fn quartile(times: &mut [f64], quarter: usize) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() * quarter / 4]
}

fn main() -> Result<(), Failure> {
    println!("| chain of buffers | framegraph, ns a pass (p25, median) | zenfg 0.2, ns a pass (p25, median) | ratio of medians |");
    println!("| --- | --- | --- | --- |");
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
        let [a25, a50] = [1, 2].map(|q| quartile(&mut a, q));
        let [b25, b50] = [1, 2].map(|q| quartile(&mut b, q));
        println!("| {passes} | {a25:.0}, {a50:.0} | {b25:.0}, {b50:.0} | {:.1} |", b50 / a50);
    }
    Ok(())
}
