//! What a test did not do, and which adapter it used: in words, on the screen and for `cargo xtask test`, which fails for skips
//! that it does not know and where no test named an adapter.
//!
//! A test that returns early says so here; one that returns in silence counts as passed.

pub mod display;

use std::fs::OpenOptions;
use std::io::Write;

/// The variable that names the file in which `cargo xtask test` collects such lines.
const LOG: &str = "FRAMEGRAPH_SKIP_LOG";

/// Says that `test` is skipped, and why.
pub fn skip(test: &str, why: &str) {
    line(&format!("SKIP: {test}: {}", why.replace('\n', " ")));
}

/// Says which adapter the tests run on.
pub fn adapter(name: &str) {
    line(&format!("ADAPTER: {name}"));
}

/// Prints the result of a test in a line; `cargo xtask test` collects it.
pub fn result(test: &str, counts: &str) {
    line(&format!("RESULT: {test}: {}", counts.replace('\n', " ")));
}

/// The variable that asks for all cases of all tests: `all`.
const CASES: &str = "FRAMEGRAPH_TESTS";

/// Returns whether all cases of all tests are asked for, as `cargo xtask test --all` does.
pub fn is_all() -> bool {
    std::env::var_os(CASES).is_some_and(|cases| cases == "all")
}

/// Of the cases of a test that draws for long, those that run: the first of each three, or all of them where
/// `FRAMEGRAPH_TESTS=all` asks for that, as `cargo xtask test --all` does. What is left out is counted there.
pub fn share<T>(cases: impl IntoIterator<Item = T>) -> Vec<T> {
    let all = is_all();
    let cases: Vec<T> = cases.into_iter().collect();
    let count = cases.len();
    let run: Vec<T> = cases.into_iter().step_by(if all { 1 } else { 3 }).collect();
    // The harness names the thread of a test by the test.
    let thread = std::thread::current();
    line(&format!("CASES: {}: {} of {count}", thread.name().unwrap_or("test"), run.len()));
    run
}

#[allow(clippy::print_stdout, reason = "shown with --nocapture")]
fn line(text: &str) {
    println!("{text}");
    let Some(path) = std::env::var_os(LOG) else { return };
    // One write in append mode: lines of tests that run at once do not mix. A log that cannot be written loses lines, not
    // the test.
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
