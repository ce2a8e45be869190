//! Mutants of valid plans, which the checker must reject.

use crate::document::Document;
use crate::oracle::DEVICES;
use crate::table::{Table, percent};
use framegraph::{Caps, Plan, Scratch, compile};
use framegraph_check::generate::{self, Entropy, Profile, options_of};
use framegraph_check::mutation::MutationReport;

/// Plans in the quick run.
pub const QUICK: usize = 9;

/// Plans in the long run.
pub const LONG: usize = 2_000;

/// Counts rejected mutants over many plans, and lists accepted ones with the proof that they are valid.
pub fn section(document: &mut Document, plans: usize, note: &str) {
    let mut report = MutationReport::default();
    let profile = Profile { max_passes: 6, ..Profile::default() };
    let (mut scratch, mut plan) = (Scratch::new(), Plan::new());
    for seed in 0..plans {
        document.at("mutants", seed, plans);
        let graph = generate::graph(&mut Entropy::seeded(seed as u64), &profile);
        let caps = generate::capable(Caps::preset(DEVICES[seed % DEVICES.len()]).unwrap_or_default());
        // Coprime to the number of combinations, so that every combination occurs.
        let options = options_of(seed as u32 * 7);
        compile(&graph, &caps, &options, &mut scratch, &mut plan)
            .unwrap_or_else(|errors| panic!("seed {seed}: {errors}"));
        report.take(&plan);
    }
    let MutationReport { plans, mutants, caught, fields, excused, alive } = report;
    let mut table = Table::new(&["field", "equivalent mutants", "proof of equivalence"]);
    for ((field, proof), count) in &excused {
        table.row(vec![(*field).to_owned(), count.to_string(), (*proof).to_owned()]);
    }
    let mut text = format!(
        "One field of one row of a valid plan is changed at a time: {mutants} mutants. The oracle rejects {caught} of \
         them ({}).\n{} are equivalent to the plan, with a proof for each; {} survive without a proof.\n\n{}",
        percent(caught, mutants),
        mutants - caught - alive.len(),
        alive.len(),
        table.text()
    );
    if plans >= LONG {
        let mut table = Table::new(&["field", "mutants", "rejected", "equivalent"]);
        for (field, (mutants, caught)) in fields {
            table.row(vec![field.to_owned(), mutants.to_string(), caught.to_string(), (mutants - caught).to_string()]);
        }
        text += &format!("\n{}", table.text());
    }
    document.section(&format!("Mutants of {plans} plans{note}"), &text);
    document.faults.extend(alive.iter().map(|line| format!("a mutant survives: {line}")));
}
