//! Compiles a frame graph from a file without a GPU.
//!
//! Prints the plan and its cost for a chosen device, size and set of features, compares two graphs, and checks
//! budgets and expected outputs.

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
        Ok(Command::Help(text)) => {
            program::print(text);
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
        Err(run::Failure::Assertion(message)) => fail(1, &message),
        Err(run::Failure::Input(message)) => fail(2, &message),
    }
}

/// Prints each line of `message` on standard error and returns the exit code.
fn fail(code: u8, message: &str) -> ExitCode {
    message.lines().for_each(program::note);
    program::exit(code)
}
