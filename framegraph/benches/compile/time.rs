//! Measures nanoseconds and instructions per declared pass.

use crate::count::{self, What};
use crate::{Frames, works};
use framegraph::recompile;
use std::fmt;
use std::hint::black_box;
use std::time::Instant;

/// Nanoseconds per pass: of the median sample, and of the fastest, which is least affected by other work on the
/// machine.
#[derive(Clone, Copy, Debug)]
pub struct Time {
    pub median: f64,
    pub fastest: f64,
}

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:.1} ({:.1})", self.median, self.fastest)
    }
}

/// Measures `run` for about a second.
pub fn time(passes: usize, mut run: impl FnMut()) -> Time {
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
    Time { median: times[times.len() / 2], fastest: times[0] }
}

/// Measures declaring, compiling, both, and recognizing an equal graph.
fn times(frames: &mut Frames) -> [Time; 4] {
    let n = frames.passes();
    let declared = time(n, || black_box(&mut *frames).declare());
    let compiled = time(n, || black_box(&mut *frames).compile());
    let both = time(n, || {
        black_box(&mut *frames).declare();
        frames.compile();
    });
    // Alternates between two equal graphs: a graph that is passed twice shares its arrays with the plan, which is
    // trivial to recognize.
    frames.declare();
    let mut equal = Frames::new(frames.work.clone());
    equal.declare();
    let mut turn = false;
    let unchanged = time(n, || {
        turn = !turn;
        let graph = if turn { &equal.graph } else { &frames.graph };
        let again = recompile(black_box(graph), &frames.caps, &frames.options, &mut frames.scratch, &mut frames.plan);
        assert!(again.is_ok_and(|compiled| !compiled), "an equal graph was compiled again");
    });
    [declared, compiled, both, unchanged]
}

const HEAD: &str = "\
## Declaring and compiling

Nanoseconds for each declared pass, the median of some hundred samples and in parentheses the fastest, and instructions.
Declaring is every call on the graph, with all checks of handles, kinds and ranges. Compiling is every phase but the
optimising order and heap aliasing: validation, culling, merging, lifetimes, loads and stores, memoryless attachments, the
pool, the decision log. The aim is for both. An unchanged graph is recognised by comparing everything that was declared.

| graph | declare, ns | compile, ns | both, ns | aim, ns | unchanged, ns | declare, instr. | compile, instr. |
| --- | --- | --- | --- | --- | --- | --- | --- |";

/// Prints the table.
pub fn print() {
    program::line(HEAD);
    let mut why = None;
    for (work, aim) in works() {
        let counted = [What::Declare, What::Compile].map(|what| match count::instructions(&work, what) {
            Ok(count) => format!("{count:.0}"),
            Err(reason) => {
                why = Some(reason);
                "not counted".into()
            }
        });
        let mut frames = Frames::new(work);
        let [declared, compiled, both, unchanged] = times(&mut frames);
        let aim = aim.map_or_else(String::new, |aim| aim.to_string());
        program::line(format_args!(
            "| {} | {declared} | {compiled} | {both} | {aim} | {unchanged} | {} | {} |",
            frames.work.name, counted[0], counted[1]
        ));
    }
    program::line("");
    match why {
        None => program::line(
            "Instructions are those that valgrind's callgrind counts in warm frames; they do not depend on load.\n",
        ),
        Some(reason) => program::line(format_args!("Instructions were not counted: {reason}.\n")),
    }
}
