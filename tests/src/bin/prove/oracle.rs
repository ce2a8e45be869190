//! Independent checker on random graphs: every plan is correct and wastes nothing.

use crate::document::Document;
use crate::table::Table;
use framegraph::{Caps, Options, Order, Plan, Scratch, compile};
use framegraph_check::check;
use framegraph_check::generate::{self, Entropy, OPTIONS, Profile, options_of};

/// Graphs in the quick run.
pub const QUICK: usize = 100;

/// Graphs in the long run.
pub const LONG: usize = 100_000;

/// Presets whose rules differ most.
pub const DEVICES: [&str; 3] = ["desktop", "tiler", "wgpu"];

/// Prints the table over many graphs, for each preset.
pub fn section(document: &mut Document, graphs: usize, note: &str) {
    let columns =
        ["device", "graphs", "plans", "steps", "merged passes", "barriers", "decisions", "violations", "wastes"];
    let mut table = Table::new(&columns);
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    for (index, name) in DEVICES.iter().enumerate() {
        let caps = generate::capable(Caps::preset(name).unwrap_or_default());
        let mut counts = [0usize; 7];
        let mut first = None;
        for seed in 0..graphs {
            document.at(&format!("oracle, {name}"), seed, graphs);
            let graph = generate::graph(&mut Entropy::seeded(seed as u64), &Profile::default());
            // Over all seeds, every combination of options occurs; the defaults and the optimizing order always do.
            let any = options_of((seed as u32).wrapping_mul(3).wrapping_add(index as u32) % OPTIONS);
            for options in [options_of(0), Options { order: Order::Optimized, ..options_of(0) }, any] {
                compile(&graph, &caps, &options, &mut scratch, &mut plan)
                    .unwrap_or_else(|errors| panic!("seed {seed}: {errors}"));
                let report = check::examine(&plan);
                if first.is_none() && !report.is_clean() {
                    first = Some(format!("seed {seed}, {options:?}: {report:?}"));
                }
                let found = [
                    1,
                    plan.steps().len(),
                    plan.step_passes().len() - plan.steps().len(),
                    plan.barriers().len(),
                    plan.decisions().len(),
                    report.violations.len(),
                    report.wastes.len(),
                ];
                counts.iter_mut().zip(found).for_each(|(sum, n)| *sum += n);
            }
        }
        let told = first.unwrap_or_default();
        document.claim(told.is_empty(), || format!("the oracle rejects plans for {name}: {told}"));
        let cells = counts.map(|n| n.to_string());
        table.row([vec![(*name).to_owned(), graphs.to_string()], cells.to_vec()].concat());
    }
    document.section(
        &format!("The oracle on {graphs} random graphs{note}"),
        &format!(
            "Each graph is planned with the defaults, with the optimizing order, and with one of all {OPTIONS} combinations \
             of options.\n\n{}",
            table.text()
        ),
    );
}
