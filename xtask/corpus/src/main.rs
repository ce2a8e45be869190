//! The program behind `cargo xtask corpus`.

use corpus::args::{self, Command};
use corpus::table;
use program::interrupt;
use std::process::ExitCode;

fn main() -> ExitCode {
    let args = match args::parse(std::env::args_os().skip(1)) {
        Ok(Command::Run(args)) => args,
        Ok(Command::Help(text)) => {
            program::print(text);
            return program::exit(0);
        }
        Err(message) => return fail(2, &message),
    };
    interrupt::watch();
    match corpus::run(&args) {
        Ok(outcome) if outcome.stopped.is_some() => {
            let signal = outcome.stopped.map_or(0, interrupt::Stopped::code);
            let (done, total) = (outcome.report.files.len(), outcome.total);
            fail(signal, &format!("stopped with {done} of {total} files done; the same command resumes there"))
        }
        Ok(outcome) => {
            program::print(table::markdown(&outcome.report));
            outcome.written.iter().for_each(|file| program::line(format_args!("wrote {}", file.display())));
            program::exit(u8::from(outcome.report.has_faults()))
        }
        Err(message) => fail(2, &message),
    }
}

/// Prints one line on standard error.
fn fail(code: u8, message: &str) -> ExitCode {
    program::error(message);
    program::exit(code)
}
