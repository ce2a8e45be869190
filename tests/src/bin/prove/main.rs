//! `prove`: verifies the compiler's claims and prints the results as a document. It measures how close memory is to the
//! optimum, checks plans for correctness, and tests the checker itself.
//!
//! Apart from times, the output is the same on every machine. `--quick` prints only the parts that a test compares with
//! `docs/measurements/proofs.md`. The document goes to standard output, progress to standard error. The document is written once it
//! is complete, so the program can be interrupted at any time. Exit codes: 0 every claim holds, 1 a claim is refuted
//! and named, 2 invalid input.

mod aliasing;
mod args;
mod document;
mod frames;
mod instances;
mod listed;
mod mutants;
mod oracle;
mod planted;
mod pools;
mod table;

use args::{Args, Command};
use document::Document;
use program::interrupt;
use program::outputs::Outputs;
use std::process::ExitCode;

fn main() -> ExitCode {
    let args = match args::parse(std::env::args_os().skip(1)) {
        Ok(Command::Run(args)) => args,
        Ok(Command::Help(text)) => {
            program::print(text);
            return program::exit(0);
        }
        Err(error) => return fail(2, &[error]),
    };
    interrupt::exit_when_asked();
    match run(&args) {
        Ok(faults) if faults.is_empty() => program::exit(0),
        Ok(faults) => fail(1, &faults),
        Err(error) => fail(2, &[error]),
    }
}

fn fail(code: u8, errors: &[String]) -> ExitCode {
    for error in errors {
        program::note(format_args!("prove: {error}"));
    }
    program::exit(code)
}

/// Runs all proofs, and writes the document to a file atomically, or to standard output. Returns refuted claims.
fn run(args: &Args) -> Result<Vec<String>, String> {
    let mut outputs = Outputs::default();
    if let Some(out) = &args.out {
        outputs.add(out).map_err(|error| format!("--out: {error}"))?;
    }
    let Document { text, faults, .. } = document(args)?;
    match &args.out {
        None => program::print(text),
        Some(out) => {
            let written = outputs.write(out, |file| file.write_all(text.as_bytes())).and_then(|()| outputs.commit());
            written.map_err(|error| error.to_string())?;
        }
    }
    Ok(faults)
}

/// Creates the document, without the long tables if `quick` is set.
fn document(args: &Args) -> Result<Document, String> {
    let mut document = Document::new(
        "# Proofs\n\nPrinted by `cargo xtask prove`. A test compares all tables except those of long runs. Apart from times,\n\
         the figures are the same on every machine. Peak memory and speed are in [performance.md](performance.md).\n",
    );
    aliasing::section(&mut document, aliasing::QUICK, "");
    pools::section(&mut document, aliasing::QUICK, "");
    planted::quick(&mut document)?;
    listed::section(&mut document)?;
    oracle::section(&mut document, oracle::QUICK, "");
    mutants::section(&mut document, mutants::QUICK, "");
    if !args.quick {
        aliasing::section(&mut document, aliasing::LONG, ", long run");
        pools::section(&mut document, aliasing::LONG, ", long run");
        aliasing::large(&mut document);
        instances::section(&mut document, args.dsa.as_deref())?;
        planted::long(&mut document)?;
        oracle::section(&mut document, oracle::LONG, ", long run");
        mutants::section(&mut document, mutants::LONG, ", long run");
    }
    Ok(document)
}
