//! Plans a frame from a file, without a GPU: what it would cost on a device, at a size, with a feature, against another
//! frame, and whether that is within a budget.

mod args;
mod offsets;
mod output;
mod plugins;
mod queues;
mod run;

use args::Command;
use program::interrupt;
use std::process::ExitCode;

fn main() -> ExitCode {
    interrupt::exit_when_asked();
    let outcome = match args::parse(std::env::args_os().skip(1)) {
        Err(message) => Err(run::Failure::Input(message)),
        Ok(Command::Help) => {
            program::print(args::HELP);
            Ok(())
        }
        Ok(Command::Plugins) => {
            program::print(plugins::listed(&plugins::registry()));
            Ok(())
        }
        Ok(Command::Plan(args)) => run::run(&args, &plugins::registry()),
        Ok(Command::Offsets(args)) => offsets::run(&args).map_err(run::Failure::Input),
    };
    match outcome {
        Ok(()) => program::exit(0),
        Err(run::Failure::Budget(message)) => fail(1, &message),
        Err(run::Failure::Input(message)) => fail(2, &message),
    }
}

/// The message on standard error; a line for each error.
fn fail(code: u8, message: &str) -> ExitCode {
    message.lines().for_each(program::note);
    program::exit(code)
}
