//! Combinations of effects, options and scene parts, each rendered by a separate `render` process.

use crate::support::{LIGHT, folder};
use corpus::combinations::{Options, run};
use corpus::verdict::Verdict;
use std::path::PathBuf;
use std::time::Duration;

/// Every pair of levels renders without a crash, a device error or non-finite radiance. With all cases (`cargo xtask test
/// --all`), every triple does.
#[test]
fn every_combination_is_drawn() {
    const TEST: &str = "every_combination_is_drawn";
    let options = Options {
        strength: if test_report::is_all() { 3 } else { 2 },
        render: PathBuf::from(env!("CARGO_BIN_EXE_render")),
        folder: folder("combinations"),
        light: PathBuf::from(LIGHT),
        jobs: std::thread::available_parallelism().map_or(1, usize::from),
        limit: Duration::from_secs(300),
        memory_bytes: 4 << 30,
    };
    let outcome = run(&options, &|_, _| {}).expect("the cases run");
    let without_adapter = outcome.cases.iter().filter(|case| case.judged.message.contains("no adapter")).count();
    if without_adapter == outcome.total {
        return test_report::skip(TEST, "no adapter");
    }
    test_report::result(TEST, &outcome.counts());
    assert_eq!(outcome.cases.len(), outcome.total);
    assert!(outcome.count(Verdict::Ok) > outcome.total / 2, "{outcome}");
    assert_eq!(outcome.faults().count(), 0, "{outcome}");
}
