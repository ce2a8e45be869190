//! Plans a frame from a file, without a GPU: what it would cost on a device, at a size, with a feature, against another
//! frame, and whether that is within a budget.

mod args;
mod budget;
mod offsets;
mod output;
mod plugins;
mod run;

use args::Command;
use std::process::ExitCode;

fn main() -> ExitCode {
    let outcome = match args::parse(std::env::args_os().skip(1)) {
        Err(message) => Err(run::Failure::Input(message)),
        Ok(Command::Help) => output::print(args::HELP).map_err(run::Failure::Input),
        Ok(Command::Plugins) => output::print(&plugins::listed(&plugins::registry())).map_err(run::Failure::Input),
        Ok(Command::Plan(args)) => run::run(&args, &plugins::registry()),
        Ok(Command::Offsets(args)) => offsets::run(&args).map_err(run::Failure::Input),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(run::Failure::Budget(message)) => fail(1, &message),
        Err(run::Failure::Input(message)) => fail(2, &message),
    }
}

/// The message on standard error; a line for each error.
fn fail(code: u8, message: &str) -> ExitCode {
    for line in message.lines() {
        eprintln!("{line}");
    }
    ExitCode::from(code)
}
