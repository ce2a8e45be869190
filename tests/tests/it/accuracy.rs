//! The committed documents match their records, and `accuracy` reports invalid options.

use crate::stage::gpu;
use framegraph_passes::quality::Measured;
use framegraph_passes::quality::preset::source;
use framegraph_passes::{Facts, Preset};
use std::path::Path;
use std::process::{Command, Output};
use tests::lab::budget::{Bench, verify};
use tests::lab::markdown::document;
use tests::lab::record::{Record, Rounds};
use tests::lab::studio::Studio;

const DOCUMENT: &str = include_str!("../../../docs/measurements/accuracy.md");
const CHOSEN: &str = include_str!("../../../passes/src/quality/preset/chosen.rs");

fn record() -> Record {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/measurements/accuracy.json");
    Record::read(&path).expect("the record of the document")
}

fn accuracy(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_accuracy")).args(args).output().expect("the program starts")
}

#[test]
fn the_document_is_that_of_its_record() {
    let mut record = record();
    assert_eq!(
        DOCUMENT,
        document(&record),
        "renew it: cargo run -p tests --bin accuracy -- --out docs/measurements --document > docs/measurements/accuracy.md"
    );
    assert!(record.techniques.len() >= 24, "{} techniques", record.techniques.len());
    // The most common question: samples, error, time, and presets.
    assert!(DOCUMENT.contains("What does ambient occlusion with 7 taps cost against 16? **7 taps"), "it is answered");
    let taps = record.techniques.iter().find(|t| t.name == "ao-taps").expect("taps of ambient occlusion");
    let of = |count: &str| taps.choices.iter().find(|c| c.name.starts_with(count)).expect("so many taps");
    assert!(of("7 ").error > of("16 ").error && of("7 ").ms.is_some() && of("16 ").presets == ["high"]);
    record.techniques[0].choices[0].error += 1.0;
    assert_ne!(DOCUMENT, document(&record), "another error is another document");
}

/// Techniques that were added after the record of a GPU was made.
const NOT_ON_THE_GPU: [&str; 5] =
    ["environment-storage", "environment-filter", "irradiance", "transparency", "tone-fit"];

/// The record of a GPU has its own document, with the same techniques except for newer ones.
#[test]
fn the_document_of_a_gpu_is_that_of_its_record() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/measurements/nvidia-h200");
    let own = Record::read(&folder.join("accuracy.json")).expect("the record of the document");
    let text = std::fs::read_to_string(folder.join("accuracy.md")).expect("the document");
    let renew = "renew it: cargo run -p tests --bin accuracy -- --out docs/measurements/nvidia-h200 --document > docs/measurements/nvidia-h200/accuracy.md";
    assert_eq!(text, document(&own), "{renew}");
    assert!(own.adapter.contains("NVIDIA H200"), "{}", own.adapter);
    let names = |record: Record| record.techniques.into_iter().map(|technique| technique.name).collect::<Vec<_>>();
    let mut expected = names(record());
    expected.retain(|name| !NOT_ON_THE_GPU.contains(&name.as_str()));
    assert_eq!(names(own), expected);
}

/// The presets match the choice from the committed record, and another record leads to another choice.
#[test]
fn presets_are_those_of_the_record() {
    let mut measured = record().budget.expect("docs/measurements/accuracy.json has what frames are chosen from");
    let renew = "renew them: cargo run -p tests --bin accuracy -- --out docs/measurements --presets passes/src/quality/preset/chosen.rs";
    assert_eq!(CHOSEN, source(&measured).expect("options that there are"), "{renew}");
    for preset in Preset::ALL {
        assert_eq!(preset.measured(&measured, |_| true).expect("options that there are"), preset.frame(), "{renew}");
    }
    let edges = measured.groups.iter_mut().find(|group| group.name == "edges").expect("a group");
    edges.options.iter_mut().for_each(|option| option.ms = 1.0);
    assert_ne!(CHOSEN, source(&measured).expect("options that there are"), "samples that cost nothing are taken");
}

/// Chosen sets meet a hundred budgets. By the record, no change of one option within the budget reduces the error.
#[test]
fn chosen_sets_fit_their_budgets() {
    let measured = record().budget.expect("docs/measurements/accuracy.json has what frames are chosen from");
    let choices = measured.choices(&Facts::default(), |_| true).expect("options that there are");
    let offers = measured.offers(&choices, measured.fastest_ms, measured.reference_ms);
    assert!(offers.groups.len() > 5, "{} groups", offers.groups.len());
    let [low, high] = [offers.fastest(), offers.finest()].map(|set| offers.predicted(&set).ms);
    for step in 0..100 {
        let budget = low + (high - low) * (f64::from(step) * 0.618_034).fract();
        let set = offers.within_ms(budget).expect("the fastest set fits");
        assert!(set.ms <= budget);
        for (group, options) in offers.groups.iter().enumerate() {
            for option in 0..options.len() {
                let mut swapped = set.options.clone();
                swapped[group] = option;
                let swapped = offers.predicted(&swapped);
                assert!(swapped.ms > budget || swapped.squares >= set.squares - 1e-9, "{budget} ms: {set:?}");
            }
        }
    }
}

/// Short form of `accuracy --verify`: draws the frames chosen for budgets, and every change of one option that fits.
/// Times are taken from the record, so that the result does not depend on the machine's load.
#[test]
fn no_change_of_a_chosen_frame_has_less_error() -> Result<(), Box<dyn std::error::Error>> {
    let Some(gpu) = gpu("no_change_of_a_chosen_frame_has_less_error") else { return Ok(()) };
    let record = record();
    let mut measured =
        record.budget.clone().ok_or("docs/measurements/accuracy.json has what frames are chosen from")?;
    let studio = Studio::new(&gpu, record.size_px, Rounds::QUICK);
    let mut bench = Bench::new(&studio);
    let verified = |bench: &mut Bench<'_>, measured: &Measured| {
        verify(bench, measured, 3, &mut |_, _, given, set| Ok(given.predicted(set).ms), &mut |_| ())
    };
    let found = verified(&mut bench, &measured)?;
    assert!(found.within == found.budgets && found.swaps > 10 && found.better.is_empty(), "{found:?}");
    // Negative control: a record whose best frames have no ambient occlusion and shadows.
    let worthless =
        measured.groups.iter_mut().filter(|group| ["occlusion", "sun-shadows", "edges"].contains(&&*group.name));
    for group in worthless {
        let finest = group.options[0].codes;
        group.options.iter_mut().for_each(|option| option.codes = finest - option.codes);
    }
    measured.pairs.clear();
    let found = verified(&mut bench, &measured)?;
    assert!(!found.better.is_empty(), "{found:?}");
    Ok(())
}

#[test]
fn invalid_options_are_reported() {
    for (args, words) in [
        (&["--technique"][..], "missing NAME"),
        (&["--budget-ms", "-1"], "a number of at least 0"),
        (&["--scene", "sepia"], "--scene sepia: expected"),
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
