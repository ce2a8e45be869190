//! Engine that owns its device, surface and pipelines, with two effects from the render graph. See `README.md` in this
//! package.

mod args;
mod headless;
mod window;

use args::Command;
use framegraph_wgpu::AdapterRequest;
use program::interrupt;
use std::fmt::Display;
use std::process::ExitCode;

/// Reason that nothing was drawn.
enum Failure {
    /// Invalid input.
    Input(String),
    /// Device failure or internal error.
    Device(String),
}

impl Failure {
    fn device(error: impl Display) -> Self {
        Self::Device(error.to_string())
    }
}

fn main() -> ExitCode {
    let args = match args::parse(std::env::args_os().skip(1)) {
        Ok(Command::Draw(args)) => args,
        Ok(Command::Help(text)) => {
            program::print(text);
            return program::exit(0);
        }
        Err(message) => return fail(2, &message),
    };
    let known = AdapterRequest::from_env().check().map_err(|error| Failure::Input(error.to_string()));
    let done = known.and_then(|()| match &args.out {
        Some(out) => headless::run(&args, out),
        None => window::run(&args),
    });
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
