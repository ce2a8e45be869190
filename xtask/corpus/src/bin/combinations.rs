//! Renders combinations of effects, options and parts of scenes, and reports the cases that fail.

use corpus::combinations::{Options, Rendered, run};
use program::cli::{self, Parsed, flag, option};
use program::interrupt;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

const ABOUT: &str = "Renders combinations of effects, options and parts of scenes, each by its own `render` process.";

const AFTER: &str = "Exit codes: 0 no findings, 1 findings, 2 bad input or output, 128 and its number after a signal.";

fn main() -> ExitCode {
    let options = match parse() {
        Ok(Wanted::Run(options)) => options,
        Ok(Wanted::Help(text)) => {
            program::print(text);
            return program::exit(0);
        }
        Err(error) => {
            program::error(error);
            return program::exit(2);
        }
    };
    interrupt::watch();
    let show = |case: &Rendered, total: usize| {
        let (number, word, took) = (case.number, case.judged.verdict.word(), case.took.as_secs_f64());
        program::line(format_args!("{number} of {total}: {word}, {took:.1} s: render {}", case.line));
    };
    match run(&options, &show) {
        Ok(outcome) => {
            program::print(outcome.to_string());
            let findings = u8::from(outcome.faults().next().is_some());
            program::exit(interrupt::check().err().map_or(findings, interrupt::Stopped::code))
        }
        Err(message) => {
            program::error(&message);
            program::exit(2)
        }
    }
}

/// Parsed command line.
enum Wanted {
    /// Print the help.
    Help(String),
    /// Render combinations.
    Run(Options),
}

/// Reads the command line.
fn parse() -> Result<Wanted, String> {
    let command = cli::command("combinations", ABOUT, AFTER).args([
        option("render", "PROGRAM", "The `render` program").required(true),
        flag("triples", "Every combination of three levels instead of two"),
        option("folder", "FOLDER", "Scenes and scraps (target/combinations)"),
        option("jobs", "N", "Processes at a time (the number of cores)"),
        option("seconds", "N", "Time limit of a case in seconds (120)"),
        option("memory", "SIZE", "Limit on the resident memory of a process (4GiB)"),
    ]);
    let given = match cli::parse(command, std::env::args_os().skip(1))? {
        Parsed::Help(text) => return Ok(Wanted::Help(text)),
        Parsed::Given(given) => given,
    };
    let mut options = Options {
        strength: 2,
        render: PathBuf::new(),
        folder: PathBuf::from("target/combinations"),
        light: PathBuf::new(),
        jobs: std::thread::available_parallelism().map_or(1, usize::from),
        limit: Duration::from_secs(120),
        memory_bytes: 4 << 30,
    };
    let absolute = |path: PathBuf| std::path::absolute(&path).map_err(|error| format!("{}: {error}", path.display()));
    for item in given {
        match item.name() {
            "render" => options.render = absolute(item.raw().into())?,
            "triples" => options.strength = 3,
            "folder" => options.folder = item.raw().into(),
            "jobs" => options.jobs = item.parse("a number of processes", |text| text.parse().ok())?,
            "seconds" => {
                options.limit = Duration::from_secs(item.parse("a number of seconds", |text| text.parse().ok())?);
            }
            _ => options.memory_bytes = item.parse("bytes, such as 2GiB", framegraph_check::budget::bytes)?,
        }
    }
    options.folder = absolute(options.folder)?;
    options.light = options.folder.join("light");
    Ok(Wanted::Run(options))
}
