//! Random graphs on the available adapter. Everything that passes read, and all exports and imports afterwards, must
//! equal a CPU simulation that runs the declared passes one by one.
//!
//! This tests culling, order, merging, load and store operations, memoryless attachments and memory aliasing together.
//! Partial writes keep older contents visible, each frame draws other values, and memory is reused between frames and
//! graphs. Stale contents are therefore detected.

mod case;
mod control;
mod probe;
mod record;
mod record_copy;

use graph_contents::{code, copy, oracle, shader, spec};

use crate::bench::{TestResult, on_adapter, skip};
use case::{Case, Runner, Verdict};
use framegraph::{Graph, Options};
use framegraph_check::generate::{self, Entropy, FRAME, Profile};
use std::collections::BTreeMap;

/// Number of graphs to execute; ordinary runs execute a share of them.
const GRAPHS: u64 = 200;

fn graph(seed: u64) -> Graph {
    // Only 2D textures and whole buffers are simulated; `random` executes the rest.
    let profile = Profile { volumes: false, plain_accesses: true, ..Profile::default() };
    generate::graph(&mut Entropy::seeded(seed), &profile)
}

/// Returns one combination of options. Epilogues are off, since passes read more than their own pixel.
fn options(number: u32) -> Options {
    Options { inline: false, ..generate::options_of(number) }
}

#[test]
fn every_export_equals_the_oracle() -> TestResult {
    const NAME: &str = "every_export_equals_the_oracle";
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
            // The default, one of all combinations, and one of those with heap aliasing.
            for number in [0, seed as u32, 32 + seed as u32 % 32] {
                let prepared = runner.prepare(graph(seed), &options(number));
                let case = match prepared.map_err(|e| format!("seed {seed}: {e}"))? {
                    Ok(case) => case,
                    Err(why) => {
                        *beyond.entry(why).or_default() += 1;
                        break;
                    }
                };
                // Both runs of a graph use one executor, which then has the pipelines of the first.
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
