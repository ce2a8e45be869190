//! Renders combinations of effects, options and parts of scenes, and reports the cases that fail.

use corpus::combinations::{Options, Rendered, run};
use lexopt::prelude::*;
use program::interrupt;
use std::error::Error;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

const HELP: &str = "\
Renders combinations of effects, options and parts of scenes, each by its own `render` process.

usage: combinations --render PROGRAM [options]

  --render PROGRAM     the `render` program
  --triples            every combination of three levels instead of two
  --folder FOLDER      scenes and scraps (target/combinations)
  --jobs N             processes at a time (the number of cores)
  --seconds N          time limit of a case in seconds (120)
  --memory SIZE        limit on the resident memory of a process (4GiB)

Exit codes: 0 no findings, 1 findings, 2 bad input or output, 128 and its number after a signal.";

fn main() -> ExitCode {
    let options = match parse() {
        Ok(Some(options)) => options,
        Ok(None) => {
            program::line(HELP);
            return program::exit(0);
        }
        Err(error) => {
            program::error(error.to_string());
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

/// Reads the command line; none asks for the help.
fn parse() -> Result<Option<Options>, Box<dyn Error>> {
    let mut options = Options {
        strength: 2,
        render: PathBuf::new(),
        folder: PathBuf::from("target/combinations"),
        light: PathBuf::new(),
        jobs: std::thread::available_parallelism().map_or(1, usize::from),
        limit: Duration::from_secs(120),
        memory_bytes: 4 << 30,
    };
    let mut parser = lexopt::Parser::from_env();
    while let Some(argument) = parser.next()? {
        match argument {
            Long("render") => options.render = std::path::absolute(PathBuf::from(parser.value()?))?,
            Long("triples") => options.strength = 3,
            Long("folder") => options.folder = parser.value()?.into(),
            Long("jobs") => options.jobs = parser.value()?.parse()?,
            Long("seconds") => options.limit = Duration::from_secs(parser.value()?.parse()?),
            Long("memory") => {
                let size = parser.value()?.string()?;
                options.memory_bytes =
                    program::bytes(&size).ok_or(format!("--memory {size}: give bytes, such as 2GiB"))?;
            }
            Long("help") | Short('h') => return Ok(None),
            _ => return Err(argument.unexpected().into()),
        }
    }
    if options.render.as_os_str().is_empty() {
        return Err("--render: the program is missing; see --help".into());
    }
    options.folder = std::path::absolute(&options.folder)?;
    options.light = options.folder.join("light");
    Ok(Some(options))
}
