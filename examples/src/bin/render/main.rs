//! Renders a scene with the compiled render graph, without a window.

mod accuracy;
mod animation;
mod args;
mod budget;
mod compare;
mod debug;
mod decide;
mod dirt;
mod effect_costs;
mod effects;
mod explicit;
mod grade;
mod help;
mod kept_shadows;
mod latency;
mod light;
mod load;
mod name;
mod parse;
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
        Ok(Command::Help(text)) => {
            program::line(text.trim_end());
            return program::exit(0);
        }
        Err(message) => return fail(2, &message),
    };
    interrupt::watch();
    let done = match (&args.explain_error, &args.compare_with) {
        (Some(folder), _) => accuracy::explain(&args, folder),
        (_, Some(other)) => accuracy::compare(&args, other),
        _ if args.compare_post => compare::compare_post(&args),
        _ if args.debug.bisect => debug::run_bisect(&args),
        _ => run::run(&args),
    };
    match (done, interrupt::check()) {
        (Ok(()), _) => program::exit(0),
        (Err(_), Err(stopped)) => fail(stopped.code(), &stopped.to_string()),
        (Err(Failure::Input(message)), _) => fail(2, &message),
        (Err(Failure::Device(message)), _) => fail(1, &message),
    }
}

/// Prints one line on standard error and returns the exit code.
fn fail(code: u8, message: &str) -> ExitCode {
    program::error(message);
    program::exit(code)
}
