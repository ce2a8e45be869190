//! The lab's document is that of its record, and its program says what is wrong with what it is asked.

use std::path::Path;
use std::process::{Command, Output};
use tests::lab::markdown::document;
use tests::lab::record::Record;
use tests::lab::select::{groups, offers, within_budget};

const DOCUMENT: &str = include_str!("../../../docs/accuracy.md");

fn record() -> Record {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/accuracy.json");
    Record::read(&path).expect("the record of the document")
}

fn accuracy(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_accuracy")).args(args).output().expect("the program starts")
}

#[test]
fn the_document_is_that_of_its_record() {
    let mut record = record();
    assert_eq!(DOCUMENT, document(&record), "renew it: cargo run -p tests --bin accuracy -- --out docs --document");
    assert!(record.techniques.len() >= 24, "{} techniques", record.techniques.len());
    // What a newcomer asks: taps, error, time, and who has them.
    let taps = record.techniques.iter().find(|t| t.name == "ao-taps").expect("taps of ambient occlusion");
    let of = |count: &str| taps.choices.iter().find(|c| c.name.starts_with(count)).expect("so many taps");
    assert!(of("7 ").error > of("16 ").error && of("7 ").ms.is_some() && of("16 ").presets == ["high"]);
    record.techniques[0].choices[0].error += 1.0;
    assert_ne!(DOCUMENT, document(&record), "another error is another document");
}

/// Chosen sets of the record are within a hundred budgets, and no swap of one option within the budget errs less.
#[test]
fn chosen_sets_fit_their_budgets() {
    let record = record();
    let offers: Vec<_> = groups(&record).iter().map(|(_, choices)| offers(choices)).collect();
    assert!(offers.len() > 5, "{} groups", offers.len());
    let most: f64 = offers.iter().map(|group| group.iter().fold(0.0, |most, o| o.ms.max(most))).sum();
    for step in 0..100 {
        let budget = most * (f64::from(step) * 0.618_034).fract();
        let set = within_budget(&offers, budget).expect("the fastest set fits");
        assert!(set.ms <= budget);
        for (group, chosen) in offers.iter().zip(&set.options) {
            let now = group[*chosen];
            let fits = |o: &&tests::lab::select::Offer| set.ms - now.ms + o.ms <= budget;
            assert!(group.iter().filter(fits).all(|o| o.error >= now.error - 1e-12), "{budget} ms: {set:?}");
        }
    }
}

#[test]
fn wrong_questions_are_told() {
    for (args, words) in [
        (&["--technique"][..], "missing argument"),
        (&["--budget-ms", "-1"], "no number from 0 on"),
        (&["--frobnicate"], "--frobnicate"),
        (&["--document", "--out", "nowhere"], "nowhere/accuracy.json"),
    ] {
        let output = accuracy(args);
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && told.contains(words), "{args:?}: {told}");
    }
    let help = accuracy(&["--help"]);
    assert!(help.status.success() && String::from_utf8_lossy(&help.stdout).contains("--quick"));
}
