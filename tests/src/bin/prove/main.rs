//! Proves what the compiler claims, and prints it as a document: how near to the least its memory is, that its plans are
//! right, and that the oracle which says so is awake.
//!
//! Everything but seconds is the same on every machine. `--quick` prints what a test compares with `docs/proofs.md`;
//! without it the long tables follow. Standard output gets the document, standard error the progress; nothing is written
//! before it is whole, so it can be interrupted at any time. Exit codes: 0 every claim holds, 1 some do not, which are
//! named, 2 bad input.

mod aliasing;
mod args;
mod document;
mod frames;
mod instances;
mod listed;
mod mutants;
mod oracle;
mod pools;
mod table;

use args::Args;
use document::Document;
use std::process::ExitCode;

fn main() -> ExitCode {
    let args = match args::parse(std::env::args().skip(1)) {
        Ok(Some(args)) => args,
        Ok(None) => {
            print!("{}", args::HELP);
            return ExitCode::SUCCESS;
        }
        Err(error) => return fail(2, &[error]),
    };
    let done = document(&args).and_then(|d| args::write(args.out.as_deref(), &d.text).map(|()| d.faults));
    match done {
        Ok(faults) if faults.is_empty() => ExitCode::SUCCESS,
        Ok(faults) => fail(1, &faults),
        Err(error) => fail(2, &[error]),
    }
}

fn fail(code: u8, errors: &[String]) -> ExitCode {
    for error in errors {
        eprintln!("prove: {error}");
    }
    ExitCode::from(code)
}

/// The whole document; without the long tables where it is to be quick.
fn document(args: &Args) -> Result<Document, String> {
    let mut document = Document::new(
        "# Proofs\n\nPrinted by `cargo xtask prove`. A test compares all tables but those of long runs, which say so. \
         Figures that are no\ntimes are the same on every machine. Peak memory and speed stand in \
         [performance.md](performance.md).\n",
    );
    aliasing::section(&mut document, aliasing::QUICK, "");
    pools::section(&mut document, aliasing::QUICK, "");
    listed::section(&mut document)?;
    oracle::section(&mut document, oracle::QUICK, "");
    mutants::section(&mut document, mutants::QUICK, "");
    if !args.quick {
        aliasing::section(&mut document, aliasing::LONG, ", long run");
        pools::section(&mut document, aliasing::LONG, ", long run");
        aliasing::large(&mut document);
        instances::section(&mut document, args.dsa.as_deref())?;
        oracle::section(&mut document, oracle::LONG, ", long run");
        mutants::section(&mut document, mutants::LONG, ", long run");
    }
    Ok(document)
}
