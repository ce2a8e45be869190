//! `grading`: error of color grading tables against the exact functions.
//!
//! `cargo run --release -p tests --bin grading` prints the table of `docs/design/grading.md`. It is computed on the CPU in
//! f64, so it is the same on every machine.

use std::error::Error;
use std::process::ExitCode;
use tests::measure::grading::{HEAD, descs, error, looks};

fn main() -> ExitCode {
    program::ended("grading", run())
}

fn run() -> Result<(), Box<dyn Error>> {
    program::no_arguments()?;
    program::line(HEAD);
    for (name, look) in looks() {
        for desc in descs(&look) {
            program::line(error(name, &look, desc)?.row());
        }
    }
    Ok(())
}
