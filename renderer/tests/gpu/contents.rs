//! Random graphs with contents, on the driver that there is: what every pass reads and what every export and import holds
//! afterwards equals what the declared graph comes to, pass after pass, on the CPU.
//!
//! Culling, order, merging, load and store operations, memoryless attachments and shared memory all have to be right for
//! that: older contents show through every write that does not replace them, each frame paints other values, and memory
//! is used again from frame to frame and from graph to graph, so nothing stale is right by chance.

mod case;
mod code;
mod control;
mod copy;
mod oracle;
mod oracle_copy;
mod probe;
mod record;
mod record_copy;
mod shader;
mod spec;

use crate::bench::{TestResult, on_adapter, skip};
use case::{Case, Runner, Verdict};
use framegraph::testing::generate::{self, Entropy, FRAME, Profile};
use framegraph::{Graph, Options};
use std::collections::BTreeMap;

/// Graphs that must have been executed; a share of them in ordinary runs.
const GRAPHS: u64 = 200;

fn graph(seed: u64) -> Graph {
    // What is painted and compared here has two dimensions and whole buffers; `random` executes the rest.
    let profile = Profile { volumes: false, plain_accesses: true, ..Profile::default() };
    generate::graph(&mut Entropy::seeded(seed), &profile)
}

/// One combination of options. Passes here are no epilogues: they look at more than the pixel under them.
fn options(number: u32) -> Options {
    Options { inline: false, ..generate::options_of(number) }
}

#[test]
fn every_export_is_what_was_declared() -> TestResult {
    const NAME: &str = "every_export_is_what_was_declared";
    on_adapter(NAME, |gpu| {
        let wanted = std::env::var("FRAMEGRAPH_CONTENT_GRAPHS").ok().and_then(|n| n.parse().ok());
        let wanted = wanted.unwrap_or_else(|| test_report::share(0..GRAPHS).len() as u64);
        if let Some(why) = Runner::unfit(gpu) {
            return skip(NAME, why);
        }
        let mut runner = Runner::new(gpu)?;
        let (mut executed, mut runs, mut inlinable, mut total) = (0, 0u64, 0u64, Verdict::default());
        let mut beyond = BTreeMap::<&str, u64>::new();
        let mut seed = 0;
        while executed < wanted && seed < 4 * wanted {
            let mut ran = false;
            // The default, one of all combinations in turn, and one of those in which memory is shared whatever the shape.
            for number in [0, seed as u32, 32 + seed as u32 % 32] {
                let prepared = runner.prepare(graph(seed), &options(number));
                let case = match prepared.map_err(|e| format!("seed {seed}: {e}"))? {
                    Ok(case) => case,
                    Err(why) => {
                        *beyond.entry(why).or_default() += 1;
                        break;
                    }
                };
                // Both runs of a graph on one executor, which then has the pipelines of the first.
                let poison = seed.is_multiple_of(2);
                match runner.run(&case, poison).map_err(|e| format!("seed {seed}, options {number}: {e}"))? {
                    Ok(verdict) => {
                        ran = true;
                        runs += 1;
                        total.parts += verdict.parts;
                        total.unknown += verdict.unknown;
                        total.digests += verdict.digests;
                        total.unobserved += verdict.unobserved;
                        assert!(
                            verdict.differences.is_empty(),
                            "seed {seed}, options {number}, poison {poison}:\n{}\n{}",
                            verdict.differences.join("\n"),
                            framegraph::dump::text(&case.plan)
                        );
                    }
                    Err(why) => {
                        *beyond.entry(why).or_default() += 1;
                        break;
                    }
                }
            }
            executed += u64::from(ran);
            let inlining = Options { inline: true, ..options(0) };
            let inlines = |case: Case| case.plan.counts().inlined > 0;
            inlinable += u64::from(ran && runner.prepare(graph(seed), &inlining)?.is_ok_and(inlines));
            seed += 1;
        }
        let Verdict { parts, unknown, digests, unobserved, .. } = total;
        println!(
            "{executed} of {seed} graphs executed, {runs} runs: {parts} parts compared but for {unknown} that nobody may \
             rely on, {digests} digests; {unobserved} reads that nothing shows; {inlinable} graphs have passes that could be \
             inlined, and were not; left out {beyond:?}"
        );
        assert!(executed >= wanted, "too few graphs were executed");
        Ok(())
    })
}
