//! Compiler wrapper that records the processor time of each crate.
//!
//! Processor time hardly depends on other load, unlike wall-clock time. Cargo starts the program named in
//! `RUSTC_WRAPPER` with the compiler and its arguments.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::io::Write as _;
use std::process::{Command, ExitCode};

/// Environment variable with the path of the log. If it is set, this program acts as the wrapper.
pub const LOG: &str = "FRAMEGRAPH_RUSTC_LOG";

/// Clock ticks per second in `/proc`, which Linux fixes at 100 for programs (`USER_HZ`).
const TICKS_PER_SECOND: f64 = 100.0;

/// Runs the compiler; `arguments` are its path and arguments.
pub fn wrap(mut arguments: impl Iterator<Item = OsString>, log: &OsString) -> ExitCode {
    let Some(compiler) = arguments.next() else { return ExitCode::from(2) };
    let arguments: Vec<OsString> = arguments.collect();
    let status = match Command::new(&compiler).args(&arguments).status() {
        Ok(status) => status,
        Err(error) => {
            program::note(format_args!("xtask: {}: {error}", compiler.display()));
            return ExitCode::FAILURE;
        }
    };
    let name = arguments.iter().skip_while(|word| *word != "--crate-name").nth(1);
    if let (Some(name), Some(seconds)) = (name, children_seconds()) {
        let line = format!("{} {seconds:.2}\n", name.display());
        // A single write per line keeps lines of concurrent builds apart. If the log cannot be written, only the time
        // is lost.
        if let Ok(mut file) = fs::OpenOptions::new().create(true).append(true).open(log) {
            let _ = file.write_all(line.as_bytes());
        }
    }
    ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1))
}

/// Returns the processor time of finished child processes in seconds; `None` without `/proc` (proc(5), fields 16 and
/// 17).
pub fn children_seconds() -> Option<f64> {
    seconds("self", 13, 2)
}

/// Returns the processor time of a process and its finished children in seconds; `None` without `/proc` (proc(5),
/// fields 14 to 17).
pub fn seconds_of(process: u32) -> Option<f64> {
    seconds(&process.to_string(), 11, 4)
}

/// Sums some fields of a process, counted from the one after its name.
fn seconds(process: &str, first: usize, count: usize) -> Option<f64> {
    let stat = fs::read_to_string(format!("/proc/{process}/stat")).ok()?;
    let after_name = stat.rsplit_once(") ")?.1;
    let ticks = after_name.split(' ').skip(first).take(count).map(|word| word.parse::<f64>());
    Some(ticks.collect::<Result<Vec<_>, _>>().ok()?.iter().sum::<f64>() / TICKS_PER_SECOND)
}

/// Returns the seconds of each crate in a log. A crate that is compiled several times, such as a build script, is
/// summed.
pub fn sums(log: &str) -> BTreeMap<String, f64> {
    let mut sums = BTreeMap::new();
    for (name, seconds) in log.lines().filter_map(|line| line.split_once(' ')) {
        *sums.entry(name.to_owned()).or_insert(0.0) += seconds.parse().unwrap_or(0.0);
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_one_crate_are_added() {
        let sums = sums("a 1.50\nbuild_script_build 0.25\na 2.00\nno number\n");
        assert_eq!((sums["a"], sums["build_script_build"], sums["no"]), (3.5, 0.25, 0.0));
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_child_that_works_is_seen() {
        let before = children_seconds().expect("there is a /proc");
        let mut shell = Command::new("/bin/sh");
        shell.args(["-c", "i=0; while [ $i -lt 300000 ]; do i=$((i+1)); done"]);
        assert!(shell.status().is_ok_and(|status| status.success()));
        let after = children_seconds().expect("there is a /proc");
        assert!(after > before);
        assert!(seconds_of(std::process::id()).expect("there is a /proc") >= after);
    }
}
