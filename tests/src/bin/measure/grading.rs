//! `measure grading`: error of color grading tables against the exact functions.
//!
//! `cargo run --release -p tests --bin measure -- grading` prints the table of `docs/design/grading.md`. It is computed on the CPU in
//! f64, so it is the same on every machine.

use crate::{Outcome, no_words};
use tests::measure::grading::{HEAD, descs, error, looks};

/// Prints the table.
pub fn run(words: &[&str]) -> Outcome {
    no_words(words)?;
    program::line(HEAD);
    for (name, look) in looks() {
        for desc in descs(&look) {
            program::line(error(name, &look, desc)?.row());
        }
    }
    Ok(true)
}
