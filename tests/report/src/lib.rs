//! Reports of skipped tests and used adapters, printed and collected for `cargo xtask test`. It fails on an
//! unknown skip, and if no test reported an adapter.
//!
//! A test that returns early must report a skip here; otherwise it counts as passed.

pub mod display;

use std::fs::OpenOptions;
use std::io::Write;

/// Environment variable with the path of the file in which `cargo xtask test` collects reports.
const LOG: &str = "FRAMEGRAPH_SKIP_LOG";

/// Reports that `test` is skipped, with the reason.
pub fn skip(test: &str, why: &str) {
    line(&format!("SKIP: {test}: {}", why.replace('\n', " ")));
}

/// Reports the adapter that the tests run on.
pub fn adapter(name: &str) {
    line(&format!("ADAPTER: {name}"));
}

/// Reports a result of a test as one line.
pub fn result(test: &str, counts: &str) {
    line(&format!("RESULT: {test}: {}", counts.replace('\n', " ")));
}

/// Environment variable that selects all cases of all tests: `all`.
const CASES: &str = "FRAMEGRAPH_TESTS";

/// Returns true if all cases of all tests are to run, as with `cargo xtask test --all`.
pub fn is_all() -> bool {
    std::env::var_os(CASES).is_some_and(|cases| cases == "all")
}

/// Selects every third case of a slow test, or all cases if `FRAMEGRAPH_TESTS=all`, as with `cargo xtask test --all`.
/// Reports the number of cases left out.
pub fn share<T>(cases: impl IntoIterator<Item = T>) -> Vec<T> {
    let all = is_all();
    let cases: Vec<T> = cases.into_iter().collect();
    let count = cases.len();
    let run: Vec<T> = cases.into_iter().step_by(if all { 1 } else { 3 }).collect();
    // The test harness names each thread after its test.
    let thread = std::thread::current();
    line(&format!("CASES: {}: {} of {count}", thread.name().unwrap_or("test"), run.len()));
    run
}

#[allow(clippy::print_stdout, reason = "shown with --nocapture")]
fn line(text: &str) {
    println!("{text}");
    let Some(path) = std::env::var_os(LOG) else { return };
    // A single write in append mode keeps lines of concurrent tests apart. If the log cannot be written, lines are
    // lost, but the test does not fail.
    let opened = OpenOptions::new().create(true).append(true).open(path);
    if let Ok(mut file) = opened {
        let _ = file.write_all(format!("{text}\n").as_bytes());
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_share_is_every_third_case_and_its_neighbors_are_counted() {
        let run = super::share(0..10);
        assert!(run == [0, 3, 6, 9] || run == (0..10).collect::<Vec<_>>(), "{run:?}");
    }
}
