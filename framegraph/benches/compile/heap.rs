//! Cost and gain of heap aliasing, compared with a pool.

use crate::time::{Time, time};
use crate::{Frames, workload};
use framegraph::pack::{self, Interval};
use framegraph::{Alias, Caps, Effort, Options, Placement};
use std::hint::black_box;

const HEAD: &str = "\
## Heap aliasing

`dag_1000` on the desktop preset, the best of the greedy packings; nanoseconds a pass as above. Placing is what compiling
takes longer than without aliasing, with the log of who takes over whose memory; packing is the solver alone on the same
intervals. The aim of placing is 1000 ns a pass.

| aliasing | compile, ns | placing, ns | packing, ns | bytes | lower bound |
| --- | --- | --- | --- | --- | --- |";

/// Prints the time per pass for placing the resources of `dag_1000` by greedy packing.
pub fn print() {
    let caps = Caps { max_texture_texels: 16384, ..Caps::desktop() };
    let frames = |alias| {
        let options = Options { alias, effort: Effort::Greedy, ..Options::default() };
        let mut frames = Frames::with(workload::dag(1000, 42), caps.clone(), options);
        frames.declare();
        frames.compile();
        frames
    };
    let (mut apart, mut pooled, mut heaped) = (frames(Alias::Off), frames(Alias::Pool), frames(Alias::Heap));
    let n = apart.passes();
    let off = time(n, || black_box(&mut apart).compile());
    let pool = time(n, || black_box(&mut pooled).compile());
    let heap = time(n, || black_box(&mut heaped).compile());
    let items: Vec<Interval> = (heaped.plan.resources().iter())
        .filter(|row| matches!(row.placement, Placement::Heap { .. }))
        .map(|row| Interval {
            lower: row.first.index() as u32,
            upper: row.last.index() as u32 + 1,
            size: row.bytes.next_multiple_of(caps.texture_alignment_bytes),
            align: caps.texture_alignment_bytes,
        })
        .collect();
    let limits = pack::Options { effort: Effort::Greedy, ..pack::Options::default() };
    let (mut scratch, mut offsets) = (pack::Scratch::default(), Vec::new());
    let solver = time(n, || {
        let packed = pack::pack(black_box(&items), None, &limits, &mut scratch, &mut offsets);
        assert!(
            packed.is_ok_and(|packed| packed.top == heaped.plan.memory().bytes),
            "the packing differs from the plan's"
        );
    });
    program::line(HEAD);
    let rows = [("off", off, None, &apart), ("pool", pool, None, &pooled), ("heap", heap, Some(solver), &heaped)];
    for (name, time, solver, frames) in rows {
        let memory = frames.plan.memory();
        let more = Time { median: time.median - off.median, fastest: time.fastest - off.fastest };
        let placing = if name == "off" { String::new() } else { more.to_string() };
        let solver = solver.map_or_else(String::new, |solver| solver.to_string());
        program::line(format_args!(
            "| {name} | {time} | {placing} | {solver} | {} | {} |",
            memory.bytes, memory.lower_bound_bytes
        ));
    }
    program::line("");
}
