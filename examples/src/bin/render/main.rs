//! Renders a scene through the compiled render graph, headless: the main job of the project.

mod args;
mod compare;
mod debug;
mod light;
mod load;
mod look;
mod run;
mod shadows;
mod table;

use args::Command;
use std::process::ExitCode;

fn main() -> ExitCode {
    let command = match args::parse(std::env::args_os().skip(1)) {
        Ok(command) => command,
        Err(message) => return fail(2, &message),
    };
    let args = match command {
        Command::Help => {
            println!("{}", args::help());
            return ExitCode::SUCCESS;
        }
        Command::Render(args) => args,
    };
    let done = match (args.compare_post, args.debug.bisect) {
        (true, _) => compare::compare_post(&args),
        (_, true) => debug::run_bisect(&args),
        _ => run::run(&args),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(run::Failure::Input(message)) => fail(2, &message),
        Err(run::Failure::Device(message)) => fail(1, &message),
    }
}

/// One line on standard error.
fn fail(code: u8, message: &str) -> ExitCode {
    eprintln!("error: {}", message.replace('\n', " "));
    ExitCode::from(code)
}
