//! Random graphs: everything that passes read, and everything that is kept, equals a CPU simulation of the declared
//! passes. Same-pixel reads are input attachments, and attachments of one step are transient.
//!
//! The layers are silent. Negative control: plans with a broken load differ from the simulation.

mod compare;
mod copies;
mod record;

use crate::bench::{TestResult, device};
use compare::{Case, Verdict};
use framegraph::{Alias, Graph, LoadOp};
use framegraph_check::generate::{self, Entropy, Profile};
use framegraph_check::mutation::mutants;
use framegraph_queues::{QueueLayout, schedule};
use framegraph_vulkan::testing::TestDevice;
use std::collections::BTreeMap;

/// Number of graphs with `FRAMEGRAPH_TESTS=all`, each with three combinations of options.
const GRAPHS: u64 = 2000;
/// Number of graphs in ordinary runs, each with one combination.
const FEW: u64 = 200;

fn graph(seed: u64) -> Graph {
    // Only 2D textures and whole buffers are simulated.
    let profile = Profile { volumes: false, plain_accesses: true, ..Profile::default() };
    generate::graph(&mut Entropy::seeded(seed), &profile)
}

/// Compiles and executes a graph with one combination of options, on two queues for every third graph. Returns the reason
/// if it is not compiled; every error of the execution fails the test.
fn run(device: &TestDevice, seed: u64, number: u32) -> TestResult<Result<Verdict, String>> {
    let mut options = generate::options_of(number);
    let on_two = seed % 3 == 2;
    if on_two {
        options.alias = Alias::Off;
    }
    let case = match Case::new(device, graph(seed), &options) {
        Ok(case) => case,
        Err(why) => return Ok(Err(why.to_string())),
    };
    if !on_two {
        return case.run(None).map(Ok);
    }
    let costs: Vec<f64> = (0..case.plan.steps().len()).map(|step| (step * 101) as f64 % 400.0).collect();
    let found = schedule(&case.plan, &QueueLayout::async_compute(), &costs)?;
    case.run(Some(&found)).map(Ok)
}

/// Returns the number in an environment variable.
fn number(variable: &str) -> Option<u64> {
    std::env::var(variable).ok().and_then(|number| number.parse().ok())
}

#[test]
fn random_graphs_leave_the_contents_of_the_simulation() -> TestResult {
    let Some(device) = device("random_graphs_leave_the_contents_of_the_simulation") else { return Ok(()) };
    let wanted = number("FRAMEGRAPH_CONTENT_GRAPHS").unwrap_or(if test_report::is_all() { GRAPHS } else { FEW });
    let (mut executed, mut plans, mut total, mut refused) = (0, 0, Verdict::default(), BTreeMap::<String, u64>::new());
    let first = number("FRAMEGRAPH_CONTENT_SEED").unwrap_or(0);
    let mut seed = first;
    while executed < wanted && seed < first + 4 * wanted {
        let combinations = [0, seed as u32, 32 + seed as u32 % 32];
        let combinations =
            if test_report::is_all() { &combinations[..] } else { &[combinations[seed as usize / 3 % 3]] };
        for (at, &number) in combinations.iter().enumerate() {
            let ran = run(&device, seed, number);
            match ran.map_err(|error| format!("seed {seed}, options {number}: {error}"))? {
                Ok(verdict) => {
                    executed += u64::from(at == 0);
                    plans += 1;
                    let messages = device.messages();
                    let place = format!("seed {seed}, options {number}");
                    assert!(
                        messages.is_empty(),
                        "{place}: {}\n{}{:#?}",
                        messages[0],
                        framegraph::dump::text(&verdict.plan),
                        verdict.plan.barriers()
                    );
                    let text = || framegraph::dump::text(&verdict.plan);
                    assert!(verdict.differences.is_empty(), "{place}:\n{}\n{}", verdict.differences.join("\n"), text());
                    total.add(&verdict);
                }
                Err(why) => {
                    assert_eq!(device.messages(), [""; 0], "seed {seed}, options {number}");
                    *refused.entry(why.lines().next().unwrap_or_default().to_owned()).or_default() += 1;
                    break;
                }
            }
        }
        seed += 1;
    }
    let Verdict { parts, unknown, digests, in_tile, subpasses, .. } = total;
    println!(
        "{executed} of {} graphs in {plans} plans: {parts} parts compared, {unknown} undefined; {digests} digests; {in_tile} reads in \
         the tile, {subpasses} passes in later subpasses; refused {refused:#?}",
        seed - first
    );
    assert!(executed >= wanted && parts > 2 * wanted && digests > wanted, "{executed} of {wanted}");
    assert!(in_tile > 0 && subpasses > 0, "{in_tile} reads in the tile, {subpasses} passes in later subpasses");
    Ok(())
}

/// Negative control.
#[test]
fn broken_loads_differ_from_the_simulation() -> TestResult {
    let Some(device) = device("broken_loads_differ_from_the_simulation") else { return Ok(()) };
    let (mut all, mut shown) = (0, 0);
    for seed in 0..40 {
        if shown >= 4 {
            break;
        }
        let Ok(case) = Case::new(&device, graph(seed), &generate::options_of(0)) else { continue };
        let verdict = case.run(None).map_err(|error| format!("seed {seed}: {error}"))?;
        assert!(verdict.differences.is_empty(), "seed {seed}:\n{}", verdict.differences.join("\n"));
        assert_eq!(device.messages(), [""; 0], "seed {seed}");
        let mut broken = Vec::new();
        mutants(&case.plan, &mut |mutant| {
            let good = case.plan.attachments();
            let loads = |row: &framegraph::Attachment| row.load;
            let now = |row: usize| loads(&mutant.plan.attachments()[row]);
            let worse = mutant.field == "attachment.load"
                && loads(&good[mutant.row]) == LoadOp::Load
                && now(mutant.row) == LoadOp::Clear;
            if worse {
                broken.push(mutant.plan);
            }
        });
        for plan in broken.into_iter().take(2) {
            let verdict = Case::with_plan(&device, plan).run(None)?;
            (all, shown) = (all + 1, shown + usize::from(!verdict.differences.is_empty()));
        }
        drop(device.messages());
    }
    println!("{shown} of {all} broken loads are seen");
    assert!(shown >= 2, "{shown} of {all}");
    Ok(())
}
