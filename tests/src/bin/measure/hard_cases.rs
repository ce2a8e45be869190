//! `measure hard-cases`: tests of hard inputs, and the test case that needs each guard of the shader library.
//!
//! `cargo run -p tests --bin measure -- hard-cases` prints the tables of `docs/measurements/hard-cases.md`. The exit code is 1 if an invariant
//! fails, or if a guard is neither covered by a test case nor explained.

use crate::{Outcome, adapter, no_words};
use tests::hard::document::{UNNOTICED, kept, rows};
use tests::hard::judge::Questions;
use tests::hard::probe::builds;

/// Prints the tables.
pub fn run(words: &[&str]) -> Outcome {
    no_words(words)?;
    let gpu = &adapter()?;
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
