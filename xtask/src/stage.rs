//! Child processes as stages that are announced, run and timed.
//!
//! Children share this program's process group, so Ctrl-C in a terminal reaches them.

use crate::rustc_time::children_seconds;
use std::fmt;
use std::io::{BufRead as _, BufReader};
use std::process::{Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Result of a stage.
#[derive(Debug)]
pub struct Outcome {
    /// Name of the stage.
    pub name: &'static str,
    /// `Err` holds the reason.
    pub result: Result<(), String>,
    /// Wall-clock time.
    pub took: Duration,
    /// Processor time of the stage's processes, if the system reports it.
    pub processor: Option<Duration>,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.result.is_ok() { "ok" } else { "FAILED" };
        write!(f, "{:<8} {verdict:<6} {:>7.1} s", self.name, self.took.as_secs_f64())?;
        if let Some(processor) = self.processor {
            write!(f, " {:>7.1} s of processor time", processor.as_secs_f64())?;
        }
        self.result.as_ref().map_or_else(|reason| write!(f, "  ({reason})"), |()| Ok(()))
    }
}

/// Returns true if a command starts and succeeds; its output is discarded.
pub fn is_there(command: &mut Command) -> bool {
    command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}

/// Runs `command` with inherited input and output.
pub fn run(name: &'static str, command: &mut Command) -> Outcome {
    timed(name, command, |command| command.status())
}

/// Runs `command`, prints its standard output, and calls `line` for each line of it.
pub fn run_reading(name: &'static str, command: &mut Command, mut line: impl FnMut(&str)) -> Outcome {
    timed(name, command, |command| {
        let mut child = command.stdout(Stdio::piped()).spawn()?;
        if let Some(output) = child.stdout.take() {
            let mut output = BufReader::new(output);
            let mut bytes = Vec::new();
            while output.read_until(b'\n', &mut bytes)? > 0 {
                let text = String::from_utf8_lossy(&bytes);
                program::print(&text);
                line(text.trim_end());
                bytes.clear();
            }
        }
        child.wait()
    })
}

/// Formats a command as it would be typed, with arguments quoted where needed.
pub fn shown(command: &Command) -> String {
    let program = std::path::Path::new(command.get_program());
    let program = program.file_stem().unwrap_or(command.get_program());
    std::iter::once(program)
        .chain(command.get_args())
        .map(|word| word.to_string_lossy())
        .map(|word| if word.contains(' ') { format!("'{word}'") } else { word.into_owned() })
        .collect::<Vec<_>>()
        .join(" ")
}

fn timed(
    name: &'static str,
    command: &mut Command,
    run: impl FnOnce(&mut Command) -> std::io::Result<ExitStatus>,
) -> Outcome {
    program::line(format_args!("== {name}: {}", shown(command)));
    let (start, before) = (Instant::now(), children_seconds());
    let result = match run(command) {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(status.to_string()),
        Err(error) => Err(format!("cannot start `{}`: {error}", shown(command))),
    };
    let took = start.elapsed();
    let processor =
        children_seconds().zip(before).map(|(after, before)| Duration::from_secs_f64((after - before).max(0.0)));
    program::line(format_args!(
        "== {name}: {} after {:.1} s",
        if result.is_ok() { "ok" } else { "FAILED" },
        took.as_secs_f64()
    ));
    Outcome { name, result, took, processor }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn shell(script: &str) -> Command {
        let mut command = Command::new("/bin/sh");
        command.args(["-c", script]);
        command
    }

    #[test]
    fn the_exit_status_decides() {
        assert!(run("good", &mut shell("exit 0")).result.is_ok());
        let bad = run("bad", &mut shell("exit 3"));
        assert!(bad.to_string().contains("FAILED") && bad.to_string().contains("exit status: 3"));
    }

    #[test]
    fn a_program_that_is_not_there_is_named() {
        let outcome = run("none", &mut Command::new("/nowhere/no-such-program"));
        assert!(outcome.result.is_err_and(|reason| reason.contains("no-such-program")));
    }

    #[test]
    fn lines_arrive_whole_and_in_order() {
        let mut lines = Vec::new();
        let mut command = shell("echo one; printf 'two\\r\\nthr\\377ee\\n'");
        assert!(run_reading("lines", &mut command, |line| lines.push(line.to_owned())).result.is_ok());
        assert_eq!(lines, ["one", "two", "thr\u{fffd}ee"]);
    }

    /// The system reports only the total time of all children of a process. This test therefore starts itself in a
    /// process that runs no other test.
    #[test]
    fn processor_time_is_that_of_the_child() {
        const ALONE: &str = "XTASK_TEST_RUNS_ALONE";
        if std::env::var_os(ALONE).is_none() {
            let tests = std::env::current_exe().expect("a running program has a path");
            let test = "stage::tests::processor_time_is_that_of_the_child";
            let output = Command::new(tests).args(["--exact", test]).env(ALONE, "yes").output().expect("it starts");
            let said = String::from_utf8_lossy(&output.stdout);
            assert!(output.status.success() && said.contains("1 passed"), "{said}");
            return;
        }
        let busy = run("busy", &mut shell("i=0; while [ $i -lt 200000 ]; do i=$((i+1)); done"));
        let idle = run("idle", &mut shell("sleep 0.3"));
        if cfg!(target_os = "linux") {
            let of = |outcome: &Outcome| outcome.processor.expect("Linux tells it");
            assert!(of(&busy) >= Duration::from_millis(20), "{busy:?}");
            assert!(of(&idle) < of(&busy), "{idle:?} {busy:?}");
        }
    }

    #[test]
    fn a_command_is_shown_as_typed() {
        let mut command = Command::new("/usr/bin/cargo");
        command.args(["test", "two words"]);
        assert_eq!(shown(&command), "cargo test 'two words'");
    }
}
