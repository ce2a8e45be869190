//! Renders a scene through the compiled render graph, headless: the main job of the project.

mod args;
mod budget;
mod compare;
mod debug;
mod decide;
mod dirt;
mod effects;
mod given;
mod grade;
mod keep;
mod latency;
mod leave_out;
mod light;
mod load;
mod look;
mod moment;
mod name;
mod pick;
mod run;
mod sequence;
mod shadows;
mod table;
mod values;
mod what_if;

use args::Command;
use program::interrupt;
use run::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let args = match args::parse(std::env::args_os().skip(1)) {
        Ok(Command::Render(args)) => args,
        Ok(Command::Help) => {
            program::line(args::help());
            return program::exit(0);
        }
        Err(message) => return fail(2, &message),
    };
    interrupt::watch();
    let done = match (args.compare_post, args.debug.bisect) {
        (true, _) => compare::compare_post(&args),
        (_, true) => debug::run_bisect(&args),
        _ => run::run(&args),
    };
    match (done, interrupt::check()) {
        (Ok(()), _) => program::exit(0),
        (Err(_), Err(stopped)) => fail(stopped.code(), &stopped.to_string()),
        (Err(Failure::Input(message)), _) => fail(2, &message),
        (Err(Failure::Device(message)), _) => fail(1, &message),
    }
}

/// One line on standard error.
fn fail(code: u8, message: &str) -> ExitCode {
    program::error(message);
    program::exit(code)
}
