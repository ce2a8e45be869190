//! Tests that judge mutants. Each test runs alone in a process, so the first failure ends the run of a mutant. A test
//! runs only for mutants in lines of WGSL that it compiles.

use crate::Failure;
use crate::mutant::plant::Mutant;
use crate::rustc_time::seconds_of;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::Relaxed};
use std::sync::{Mutex, PoisonError};
use std::time::{Duration, Instant};

/// One test of a test program.
#[derive(Debug, Default)]
pub struct Test {
    /// Index of the test program among the room's programs.
    pub program: usize,
    /// Package of the test program.
    pub package: String,
    pub name: String,
    /// Processor time without a mutant, in seconds; wall-clock time if the system does not report it.
    pub seconds: f64,
    /// Lines of WGSL that the test compiles, such as `lib/ggx.wgsl:12`.
    lines: BTreeSet<String>,
    /// Mutants per file: how many the test ran for, and how many it detected.
    seen: Mutex<BTreeMap<String, [u32; 2]>>,
    /// True once the test has passed without a mutant.
    sound: AtomicBool,
}

/// Maximum processor time of a quick test, in seconds. Quick tests run for all mutants before slow tests run for any.
pub const QUICK: f64 = 4.0;

/// Maximum processor time per mutant, in seconds, for the quick tests and again for the slow ones. Without it, a line
/// that every test compiles would take minutes.
pub const ASKED: f64 = 45.0;

/// Result of a test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Says {
    Passed,
    /// The test fails or does not terminate.
    Fell,
    /// The test fails because the replaced shader does not compile.
    Refused,
}

/// Replacement of a WGSL file: the folder with the replaced text, and the path of the file in it.
pub type Replaced<'a> = Option<(&'a Path, &'a str)>;

impl Test {
    /// Estimates the cost of detecting one mutant of a file. Results for the same file weigh most, and a test that
    /// compiles much code detects less per line.
    fn cost(&self, file: &str) -> f64 {
        let seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        let weighted = seen.iter().map(|(of, counts)| (if of == file { 8 } else { 1 }, counts));
        let [asked, noticed] = weighted.fold([2, 1], |sum, (by, counts)| [0, 1].map(|i| sum[i] + by * counts[i]));
        // The constant 0.2 is the start-up time of a process in seconds.
        (0.2 + self.seconds) * self.lines.len().max(1) as f64 * f64::from(asked) / f64::from(noticed)
    }

    /// Counts a mutant of a file.
    pub fn count(&self, file: &str, noticed: bool) {
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        let counts = seen.entry(file.to_owned()).or_default();
        counts[0] += 1;
        counts[1] += u32::from(noticed);
    }

    /// Returns true if the test compiles the mutant's line.
    fn reaches(&self, mutant: &Mutant) -> bool {
        let path = mutant.file.trim_start_matches("shaders/wgsl/");
        self.lines.contains(&format!("{path}:{}", mutant.line))
    }

    /// Runs the test with a mutant in `file`.
    ///
    /// # Errors
    /// The program cannot be started.
    pub fn run(&self, program: &Path, folder: &Path, file: &str, replaced: Replaced<'_>) -> Result<Says, Failure> {
        let (says, _) = run(program, folder, &self.name, self.seconds, replaced, None)?;
        if says != Says::Refused {
            self.count(file, says == Says::Fell);
        }
        Ok(says)
    }
}

impl Test {
    /// Returns true if the test passes without a mutant; it is run once. A test that always fails would detect
    /// everything.
    ///
    /// # Errors
    /// The program cannot be started.
    pub fn is_sound(&self, program: &Path, folder: &Path) -> Result<bool, Failure> {
        let passes =
            || run(program, folder, &self.name, self.seconds, None, None).map(|(says, _)| says == Says::Passed);
        let sound = self.sound.load(Relaxed) || passes()?;
        self.sound.store(sound, Relaxed);
        Ok(sound)
    }
}

/// Returns the error for a test that fails without a mutant.
pub fn unsound(name: &str) -> Failure {
    Failure::Failed(format!("test `{name}` fails without a mutant"))
}

/// Returns the tests to run for a mutant: `first`, then the ones most likely to fail soon. For Rust, whose compiled
/// lines are unknown, all tests are returned.
pub fn asked<'t>(tests: &'t [Test], mutant: &Mutant, first: Option<&str>) -> Vec<&'t Test> {
    let known = |test: &&Test| !mutant.file.ends_with(".wgsl") || test.reaches(mutant);
    let mut asked: Vec<&Test> = tests.iter().filter(known).collect();
    asked.sort_by(|a, b| {
        let key = |test: &Test| (first != Some(&test.name), test.cost(&mutant.file));
        let ((a_last, a_cost), (b_last, b_cost)) = (key(a), key(b));
        a_last.cmp(&b_last).then(a_cost.total_cmp(&b_cost))
    });
    asked
}

/// Returns the names of tests that start with one of `filters` and with none of `without`.
///
/// # Errors
/// The program cannot be started.
pub fn names(program: &Path, filters: &[&str], without: &[&str]) -> Result<Vec<String>, Failure> {
    let output = Command::new(program).args(["--list", "--format", "terse"]).output();
    let output = output.map_err(|error| unstarted(program, &error))?;
    let text = String::from_utf8_lossy(&output.stdout);
    let names = text.lines().filter_map(|line| line.strip_suffix(": test"));
    let begins = |name: &&str, parts: &[&str]| parts.iter().any(|part| name.starts_with(part));
    Ok(names.filter(|name| begins(name, filters) && !begins(name, without)).map(str::to_owned).collect())
}

/// Runs a test without a mutant to measure its time and the lines it compiles.
///
/// # Errors
/// The test fails, or cannot be started.
pub fn learn(program: &Path, folder: &Path, name: String, notes: &Path) -> Result<Test, Failure> {
    let _ = fs::remove_file(notes);
    let (says, seconds) = run(program, folder, &name, f64::INFINITY, None, Some(notes))?;
    if says != Says::Passed {
        return Err(unsound(&name));
    }
    let lines = fs::read_to_string(notes).unwrap_or_default().lines().map(str::to_owned).collect();
    let _ = fs::remove_file(notes);
    Ok(Test { name, seconds, lines, sound: AtomicBool::new(true), ..Test::default() })
}

/// Runs one test and returns its processor time, or wall-clock time if the system does not report that. A test counts
/// as endless after 30 s of processor time and 20 times its normal time. It also does after 120 s and 100 times its
/// normal time by the clock.
fn run(
    program: &Path,
    folder: &Path,
    name: &str,
    seconds: f64,
    replaced: Replaced<'_>,
    notes: Option<&Path>,
) -> Result<(Says, f64), Failure> {
    let mut command = Command::new(program);
    command.args(["--exact", name]).current_dir(folder).env("NODEVICE_SELECT", "1").env("RUST_BACKTRACE", "0");
    // Mesa's software driver compiles each mutant's shader only once: without optimization that takes half the time.
    command.env("GALLIVM_PERF", "nopt").env("FRAMEGRAPH_TESTS", "all");
    if let Some((folder, _)) = replaced {
        command.env("FRAMEGRAPH_WGSL", folder);
    }
    if let Some(notes) = notes {
        command.env("FRAMEGRAPH_WGSL_LINES", notes);
    }
    static RUNS: AtomicUsize = AtomicUsize::new(0);
    let (process, run) = (std::process::id(), RUNS.fetch_add(1, Relaxed));
    let output = std::env::temp_dir().join(format!("framegraph-mutant-{process}-{run}"));
    let file = fs::File::create(&output).map_err(|error| unstarted(&output, &error))?;
    let child = command.stdout(file).stderr(Stdio::null()).spawn();
    let mut child = child.map_err(|error| unstarted(program, &error))?;
    let start = Instant::now();
    let mut took = None;
    let status = loop {
        took = seconds_of(child.id()).or(took);
        match child.try_wait().map_err(|error| unstarted(program, &error))? {
            Some(status) => break status,
            None if took.is_some_and(|took| took > 30.0 + 20.0 * seconds)
                || start.elapsed().as_secs_f64() > 120.0 + 100.0 * seconds =>
            {
                let _ = child.kill().and_then(|()| child.wait());
                let _ = fs::remove_file(&output);
                return Ok((Says::Fell, seconds));
            }
            None => std::thread::sleep(Duration::from_millis(10)),
        }
    };
    let took = took.unwrap_or_else(|| start.elapsed().as_secs_f64());
    let text = String::from_utf8_lossy(&fs::read(&output).unwrap_or_default()).into_owned();
    let _ = fs::remove_file(&output);
    if status.success() {
        return Ok((Says::Passed, took));
    }
    // A shader that does not compile is reported with its location.
    let placed = |path: &str| {
        let path = format!("{path}:");
        text.split(&path).skip(1).any(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
    };
    let refused = replaced.is_some_and(|(_, path)| placed(path));
    Ok((if refused { Says::Refused } else { Says::Fell }, took))
}

fn unstarted(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Failed(format!("{}: {error}", path.display()))
}

/// Formats measurements of tests for a file; `texts` is the hash of the shaders.
pub fn written<'t>(texts: u64, tests: impl IntoIterator<Item = &'t Test>) -> String {
    let line = |test: &Test| {
        let lines: Vec<&str> = test.lines.iter().map(String::as_str).collect();
        format!("{} {:.3} {} {}\n", test.package, test.seconds, test.name, lines.join(" "))
    };
    tests.into_iter().fold(format!("{texts:016x}\n"), |text, test| text + &line(test))
}

/// Reads measurements of tests from a file; empty if the hash of the shaders differs.
pub fn read(texts: u64, text: &str) -> Vec<Test> {
    let test = |line: &str| {
        let mut words = line.split(' ');
        let (package, seconds) = (words.next()?.to_owned(), words.next()?.parse().ok()?);
        let name = words.next()?.to_owned();
        let lines = words.filter(|word| !word.is_empty()).map(str::to_owned).collect();
        Some(Test { package, name, seconds, lines, ..Test::default() })
    };
    let (head, tests) = text.split_once('\n').unwrap_or_default();
    let same = head == format!("{texts:016x}");
    tests.lines().filter(|_| same).filter_map(test).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mutant::plant::mutants;

    fn test(name: &str, seconds: f64, lines: &[&str]) -> Test {
        let lines = lines.iter().map(|line| (*line).to_owned()).collect();
        Test { name: name.into(), seconds, lines, ..Test::default() }
    }

    #[test]
    fn tests_that_compile_the_line_run_with_the_likeliest_first() {
        let tests = [test("slow", 9.0, &["a.wgsl:1"]), test("quick", 1.0, &["a.wgsl:1"]), test("other", 0.1, &[])];
        let fault = &mutants("shaders/wgsl/a.wgsl", "a = b + c;")[0];
        let names = |first| asked(&tests, fault, first).iter().map(|test| test.name.as_str()).collect::<Vec<_>>();
        assert_eq!(names(None), ["quick", "slow"]);
        assert_eq!(names(Some("slow")), ["slow", "quick"]);
        // The quick test missed twenty mutants that the slow one detected.
        (0..20).for_each(|_| tests[1].count("a.wgsl", false));
        (0..20).for_each(|_| tests[0].count("a.wgsl", true));
        assert_eq!(names(None), ["slow", "quick"]);
    }

    #[test]
    fn what_was_learned_is_read_back() {
        let mut tests = [test("a::b", 1.5, &["a.wgsl:1", "b.wgsl:2"]), test("c", 0.25, &[])];
        tests.iter_mut().for_each(|test| test.package = "tests".to_owned());
        let text = written(7, &tests);
        let back = read(7, &text);
        assert_eq!((written(7, &back), back.len()), (text.clone(), 2));
        assert!(read(8, &text).is_empty() && read(7, "").is_empty());
    }
}
