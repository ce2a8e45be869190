//! `hard_cases`: tests of hard inputs, and the test case that needs each guard of the shader library.
//!
//! `cargo run -p tests --bin hard_cases` prints the tables of `docs/measurements/hard-cases.md`. The exit code is 1 if an invariant
//! fails, or if a guard is neither covered by a test case nor explained.

use framegraph_wgpu::{AdapterRequest, Gpu};
use std::error::Error;
use std::process::ExitCode;
use tests::hard::document::{UNNOTICED, kept, rows};
use tests::hard::judge::Questions;
use tests::hard::probe::builds;

fn main() -> ExitCode {
    match program::no_arguments().map_err(Box::from).and_then(|()| print(&Gpu::open(&AdapterRequest::from_env())?)) {
        Ok(true) => program::exit(0),
        Ok(false) => program::exit(1),
        Err(error) => {
            program::note(format_args!("hard_cases: {error}"));
            program::exit(1)
        }
    }
}

fn print(gpu: &Gpu) -> Result<bool, Box<dyn Error>> {
    program::line(format_args!("Adapter: {}\n", gpu.describe()));
    program::line("| row | input | tested by |\n| --- | --- | --- |");
    rows().iter().for_each(program::line);
    let mut sound = true;
    let mut asked = [0; 2];
    for case in builds() {
        let questions = Questions::of(case);
        asked[usize::from(case.in_half)] += questions.rows();
        for failure in questions.ask(gpu)? {
            sound = false;
            let build = if case.in_half { "f16" } else { "f32" };
            program::line(format_args!("FAILS in {build}: {}: {}", failure.name, failure.what));
        }
    }
    program::line(format_args!("\n{} evaluations in f32, {} in f16\n", asked[0], asked[1]));
    program::line("| function | guard | without it |\n| --- | --- | --- |");
    for guard in kept(gpu, 0, 1)? {
        let explained =
            UNNOTICED.iter().find(|(function, text, _)| *function == guard.function && *text == guard.guard);
        let verdict = match (&guard.by, explained) {
            (Some(case), None) => format!("fails: {case}"),
            (None, Some((.., why))) => (*why).to_owned(),
            (Some(_), Some(_)) | (None, None) => {
                sound = false;
                format!("NOT AS DOCUMENTED: {:?}", guard.by)
            }
        };
        program::line(format_args!("| {} | `{}` | {verdict} |", guard.function, guard.guard.replace('|', "\\|")));
    }
    Ok(sound)
}
