//! `cargo xtask test`: runs everything that CI runs.
//!
//! A failed stage does not stop the run, so that one run shows every problem.

use std::fs;
use std::time::Duration;

use super::Command;
use crate::options::Options;
use crate::stage::{self, Outcome};
use crate::tally::{self, Reported, Totals};
use crate::{Failure, adapter, lints, workspace};

/// The command.
pub const COMMAND: Command = Command {
    name: "test",
    summary: "run everything that CI runs: format, prose, lints, documentation, tests",
    details: "\
Stages; a failed stage does not stop the others:
  format  cargo fmt --all -- --check
  prose   cargo xtask prose: the style of docs, comments and messages
  build   every target of the workspace, with fuzz targets and benches/peers;
          clippy lints each, and rustdoc documents each library with private
          items; warnings are errors
  deny    deny.toml without advisories, if cargo-deny is installed
  tests   unit, integration and documentation tests

Some tests need Vulkan's validation layers, or Xvfb to open windows. The command
installs both like a driver; if that fails, these tests are skipped.

Slow tests with many cases run every third case; docs/measurements/time.md lists them.

Every pair of effects, options and scene parts is rendered by its own `render`
process; --all renders every triple. The summary counts the verdicts.

  --all         run all cases, build in release, and document programs too

The summary counts tests, cases that did not run, and skipped tests with their
reasons. Exit code 1 if a stage failed, if no test ran, if no test found an
adapter, or if a test skipped for a reason that is not in xtask/src/tally.rs.
",
    run,
};

/// Features that enable targets with additional requirements.
///
/// Every command uses the same features, so that dependencies are compiled only once.
const ON_DEMAND: &str = "framegraph-fuzz/fuzzer,tests-fuzz/fuzzer,peers/peer";

fn run(options: &Options) -> Result<(), Failure> {
    let expected = adapter::ready(options)?;
    adapter::checks(options);
    let all = options.has("--all");
    let wrapper = lints::Wrapper::new(&workspace::scratch()?)?;
    let building = |command: &[&str]| building(&wrapper, all, command);
    let own = std::env::current_exe().map_err(|error| Failure::Failed(format!("own path: {error}")))?;
    let mut outcomes = vec![
        stage::run("format", &mut workspace::cargo(&["fmt", "--all", "--", "--check"])),
        stage::run("prose", std::process::Command::new(own).arg("prose")),
        stage::run("build", &mut building(&["build", "--keep-going", "--all-targets"])),
    ];
    // Advisories are left to the workflow: cargo-deny downloads them, so the result depends on the network and the date.
    if stage::is_there(&mut workspace::cargo(&["deny", "--version"])) {
        let check = ["deny", "--all-features", "check", "bans", "licenses", "sources"];
        outcomes.push(stage::run("deny", &mut workspace::cargo(&check)));
    } else {
        program::line("== deny: skipped, because cargo-deny is not installed");
    }
    let (outcome, totals, reported) = tests(building(&["test", "--no-fail-fast"]), all)?;
    outcomes.push(outcome);
    program::print(summary(&outcomes, totals, &reported, &expected));
    verdict(&outcomes)
}

/// Returns a cargo command for the whole workspace that also lints and documents. With `all`, it builds in release mode
/// and documents programs too.
fn building(wrapper: &lints::Wrapper, all: bool, command: &[&str]) -> std::process::Command {
    let mut cargo = workspace::cargo(command);
    // Optional targets may need a newer compiler than the workspace.
    cargo.args(["--workspace", "--ignore-rust-version", "--features", ON_DEMAND]);
    if all {
        cargo.arg("--release");
    }
    wrapper.around(&mut cargo, all);
    cargo
}

/// Runs the tests, all cases or a subset, and collects their reports from a file.
fn tests(mut command: std::process::Command, all: bool) -> Result<(Outcome, Totals, Reported), Failure> {
    let log = workspace::scratch()?.join("skips.log");
    fs::write(&log, "").map_err(|error| Failure::Failed(format!("{}: {error}", log.display())))?;
    command.env(tally::SKIP_LOG, &log);
    if all {
        command.env("FRAMEGRAPH_TESTS", "all");
    }
    let mut totals = Totals::default();
    let mut outcome = stage::run_reading("tests", &mut command, |line| totals.add(line));
    if outcome.result.is_ok() && totals.passed == 0 {
        outcome.result = Err("no test ran".to_owned());
    }
    let text = fs::read_to_string(&log).map_err(|error| Failure::Failed(format!("{}: {error}", log.display())))?;
    let reported = Reported::from_text(&text);
    if let Some(fault) = reported.fault().filter(|_| outcome.result.is_ok()) {
        outcome.result = Err(fault);
    }
    Ok((outcome, totals, reported))
}

/// Returns the summary that the command prints last.
fn summary(outcomes: &[Outcome], totals: Totals, reported: &Reported, expected: &str) -> String {
    let Totals { runs, passed, failed, ignored } = totals;
    let Reported { skips, shares, results, adapters } = reported;
    let mut text = String::from("== summary\n");
    for outcome in outcomes {
        text += &format!("  {outcome}\n");
    }
    let processor: Option<Duration> = outcomes.iter().map(|outcome| outcome.processor).sum();
    if let Some(processor) = processor {
        text += &format!("  {:.0} s of processor time\n", processor.as_secs_f64());
    }
    text += &format!("  tests: {passed} passed, {failed} failed, {ignored} ignored, in {runs} runs\n");
    let [ran, all] = reported.cases();
    if ran < all {
        text += &format!("  cases: {ran} of {all} in tests that run a part; --all runs all\n");
        for (test, [ran, all]) in shares {
            text += &format!("    {test}: {ran} of {all}\n");
        }
    }
    for result in results {
        text += &format!("  {result}\n");
    }
    text += &format!("  skips: {}, allowed: {}\n", skips.len(), tally::known_skips());
    for skip in skips {
        text += &format!("    SKIP: {skip}\n");
    }
    if adapters.is_empty() {
        text += &format!("  adapter: no test reported one; installed: {expected}\n");
    }
    for adapter in adapters {
        text += &format!("  adapter: {adapter}\n");
    }
    text
}

/// Returns an error that names the failed stages.
fn verdict(outcomes: &[Outcome]) -> Result<(), Failure> {
    let failed: Vec<_> =
        outcomes.iter().filter(|outcome| outcome.result.is_err()).map(|outcome| outcome.name).collect();
    if failed.is_empty() {
        return Ok(());
    }
    Err(Failure::Failed(format!("failed: {}", failed.join(", "))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcomes() -> Vec<Outcome> {
        let (took, processor) = (Duration::from_millis(1500), Some(Duration::from_millis(2500)));
        vec![
            Outcome { name: "format", result: Ok(()), took, processor },
            Outcome { name: "clippy", result: Err("exit status: 101".to_owned()), took, processor },
            Outcome { name: "tests", result: Err("exit status: 1".to_owned()), took, processor },
        ]
    }

    #[test]
    fn every_failed_stage_is_named() {
        let failed = verdict(&outcomes());
        assert_eq!(failed, Err(Failure::Failed("failed: clippy, tests".to_owned())));
        assert_eq!(verdict(&outcomes()[..1]), Ok(()));
    }

    #[test]
    fn the_summary_repeats_counts_skips_and_adapter() {
        let totals = Totals { runs: 2, passed: 7, failed: 1, ignored: 0 };
        let reported = Reported::from_text(
            "SKIP: image: no f16\nCASES: looks: 3 of 9\nRESULT: pairs: 44 ok\nADAPTER: llvmpipe (Vulkan)\n",
        );
        let text = summary(&outcomes(), totals, &reported, "Vulkan, software (lvp)");
        for part in [
            "clippy   FAILED     1.5 s     2.5 s of processor time  (exit status: 101)",
            "  8 s of processor time",
            "7 passed, 1 failed, 0 ignored, in 2 runs",
            "cases: 3 of 9 in tests that run a part; --all runs all\n    looks: 3 of 9\n",
            "\n  pairs: 44 ok\n",
            "skips: 1, allowed: ",
            "\n    SKIP: image: no f16",
            "adapter: llvmpipe (Vulkan)\n",
        ] {
            assert!(text.contains(part), "`{part}` is not in:\n{text}");
        }
        let silent = summary(&outcomes(), totals, &Reported::default(), "Vulkan, software (lvp)");
        assert!(silent.contains("no test reported one; installed: Vulkan, software (lvp)"));
    }
}
