//! The instances of the MiniMalloc paper, if available.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::super::*;
use super::oracle::{exact, packed};
use crate::csv;

/// Returns the instances of `tests/offset_assignment`: name, items, and a reachable top.
fn published(test: &str) -> Vec<(String, csv::Table, u64)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/offset_assignment");
    let Ok(entries) = std::fs::read_dir(&folder) else {
        skip(test, "tests/offset_assignment does not exist");
        return Vec::new();
    };
    let mut found: Vec<_> = entries
        .flatten()
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|e| e == "csv"))
        .collect();
    found.sort();
    let instance = |path: &PathBuf| {
        let name = path.file_stem().expect("a file").to_string_lossy().into_owned();
        let capacity = name.rsplit('.').next().and_then(|text| text.parse().ok()).expect("NAME.CAPACITY.csv");
        let text = std::fs::read_to_string(path).expect("a readable file");
        (name, csv::read(&text).expect("a valid table"), capacity)
    };
    let published: Vec<_> = found.iter().map(instance).collect();
    assert!(!published.is_empty(), "no instance in {}", folder.display());
    published
}

/// Prints that a test is skipped, and appends the line to the log that `cargo xtask test` collects.
fn skip(test: &str, why: &str) {
    let line = format!("SKIP: {test}: {why}\n");
    print!("{line}");
    let Some(log) = std::env::var_os("FRAMEGRAPH_SKIP_LOG") else { return };
    // Failing to write the log must not fail the test.
    if let Ok(mut file) = std::fs::OpenOptions::new().create(true).append(true).open(log) {
        let _ = file.write_all(line.as_bytes());
    }
}

/// In debug builds the search is ten times slower; the three instances that need more than 100,000 steps stay
/// undecided.
const BUDGET: u64 = if cfg!(debug_assertions) { 100_000 } else { 1 << 24 };

#[test]
fn instances_are_packed_to_their_peak() {
    for (name, table, capacity) in published("instances_are_packed_to_their_peak") {
        let (packing, offsets) = packed(&table.items, None, exact(BUDGET), &mut Scratch::default());
        let easy = ["C", "E", "G", "K"].iter().any(|easy| name.starts_with(easy));
        if easy || !cfg!(debug_assertions) {
            let reached = packing.optimal && packing.top == packing.peak && packing.top <= capacity;
            assert!(reached, "{name}: {packing:?}");
            assert_eq!(packing.method, Method::Exact, "{name}");
        }
        let text = csv::write(&table, &offsets);
        assert_eq!(text.lines().count(), table.items.len() + 1, "{name}");
    }
}

#[test]
fn without_a_proof_the_best_found_is_returned_and_said_so() {
    for (name, table, _) in published("without_a_proof_the_best_found_is_returned_and_said_so") {
        for budget in [0, 1, 50] {
            let (packing, _) = packed(&table.items, None, exact(budget), &mut Scratch::default());
            assert!(!packing.optimal && packing.top > packing.lower_bound, "{name}: {packing:?}");
            assert!(packing.steps <= budget && packing.method != Method::Exact, "{name}: {packing:?}");
        }
    }
}
