//! What the tests reported: totals from libtest's closing lines, skips and adapters from a file.
//!
//! # The convention
//! libtest shows no output of a passing test, so a test that skips would stay silent. Such a test
//! therefore prints `SKIP: <test>: <reason>` *and*, where the environment variable
//! [`SKIP_LOG`] (`FRAMEGRAPH_SKIP_LOG`) names a file, appends the same line to it. A test that opens
//! an adapter appends `ADAPTER: <name>` in the same way. One `write` of one whole line on a file
//! opened for appending keeps lines of concurrent tests apart. `cargo xtask test` sets the variable,
//! and prints in its summary how many skips there were, each of them, and the adapters.

use std::collections::BTreeSet;

/// The environment variable that names the file for `SKIP: ` and `ADAPTER: ` lines.
pub const SKIP_LOG: &str = "FRAMEGRAPH_SKIP_LOG";

/// Sums of the `test result:` lines of all test binaries and doc tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Totals {
    /// Closing lines seen: one for each test binary and each crate's doc tests.
    pub runs: u32,
    /// Tests that passed; those that skipped are among them.
    pub passed: u32,
    /// Tests that failed.
    pub failed: u32,
    /// Tests marked `#[ignore]`.
    pub ignored: u32,
}

impl Totals {
    /// Adds `line` if it is libtest's closing line, such as
    /// `test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s`.
    pub fn add(&mut self, line: &str) {
        let Some(rest) = line.strip_prefix("test result: ") else {
            return;
        };
        self.runs += 1;
        let counts = rest.split_once(". ").map_or(rest, |(_, counts)| counts);
        for part in counts.split(';') {
            let Some((count, what)) = part.trim().split_once(' ') else {
                continue;
            };
            let Ok(count) = count.parse::<u32>() else {
                continue;
            };
            match what {
                "passed" => self.passed += count,
                "failed" => self.failed += count,
                "ignored" => self.ignored += count,
                _ => {}
            }
        }
    }
}

/// What the tests wrote into the file named by [`SKIP_LOG`].
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Reported {
    /// `<test>: <reason>`, in order of text, since tests run in no fixed order.
    pub skips: Vec<String>,
    /// Distinct adapter names, in order of text.
    pub adapters: BTreeSet<String>,
}

impl Reported {
    /// Reads the file's text. A line of neither kind counts as a skip, so that none gets lost.
    pub fn from_text(text: &str) -> Self {
        let mut reported = Self::default();
        for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
            if let Some(adapter) = line.strip_prefix("ADAPTER:") {
                reported.adapters.insert(adapter.trim().to_owned());
            } else {
                let skip = line.strip_prefix("SKIP:").unwrap_or(line);
                reported.skips.push(skip.trim().to_owned());
            }
        }
        reported.skips.sort();
        reported
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closing_lines_are_summed_and_others_ignored() {
        let mut totals = Totals::default();
        for line in [
            "running 3 tests",
            "test 5 passed; ... ok",
            "test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.00s",
            "test result: FAILED. 10 passed; 2 failed; 0 ignored; 0 measured; 0 filtered out; finished in 1.25s",
        ] {
            totals.add(line);
        }
        assert_eq!(totals, Totals { runs: 2, passed: 13, failed: 2, ignored: 1 });
    }

    #[test]
    fn skips_and_adapters_are_told_apart() {
        let text = "SKIP: b: no f16\nADAPTER: llvmpipe\n\nSKIP: a: no EXR\nADAPTER: llvmpipe\nodd\n";
        let reported = Reported::from_text(text);
        assert_eq!(reported.skips, ["a: no EXR", "b: no f16", "odd"]);
        assert_eq!(reported.adapters.into_iter().collect::<Vec<_>>(), ["llvmpipe"]);
        assert_eq!(Reported::from_text(""), Reported::default());
    }
}
